#include "idl/raw_sample.hpp"

#include <bit>
#include <cstring>
#include <utility>

namespace mpm::idl {
namespace {

constexpr std::size_t kHeader = 4;

/// Reads CDR from behind its header; offsets count from there. The encodings that our types and
/// their keys have: plain CDR, plain CDR2, delimited CDR2 (whose length precedes the first member).
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> cdr) {
    if (cdr.size() < kHeader || cdr[0] != std::byte{0}) return;
    const auto encoding = std::to_integer<unsigned>(cdr[1]);
    const bool known = encoding <= 1 || (encoding >= 6 && encoding <= 9);
    const bool little = (encoding & 1U) != 0;
    if (!known || little != (std::endian::native == std::endian::little)) return;
    delimited_ = encoding >= 8;
    eight_bytes_at_ = encoding <= 1 ? 8 : 4;
    body_ = cdr.subspan(kHeader);
  }

  [[nodiscard]] std::optional<std::string> text() {
    if (delimited_ && !skip_length()) return std::nullopt;
    const std::optional<std::uint32_t> length = number<std::uint32_t>(4);
    if (!length || *length == 0 || *length > body_.size() - at_) return std::nullopt;
    std::string text(reinterpret_cast<const char*>(body_.data()) + at_, *length - 1);
    at_ += *length;
    return text;
  }
  [[nodiscard]] std::optional<std::int64_t> integer() {
    return number<std::int64_t>(eight_bytes_at_);
  }

 private:
  [[nodiscard]] bool skip_length() {
    delimited_ = false;
    return number<std::uint32_t>(4).has_value();
  }
  template <class T>
  [[nodiscard]] std::optional<T> number(std::size_t alignment) {
    const std::size_t begin = (at_ + alignment - 1) / alignment * alignment;
    if (begin + sizeof(T) > body_.size()) return std::nullopt;
    T value;
    std::memcpy(&value, body_.data() + begin, sizeof value);
    at_ = begin + sizeof value;
    return value;
  }

  std::span<const std::byte> body_;
  std::size_t at_ = 0;
  std::size_t eight_bytes_at_ = 8;
  bool delimited_ = false;
};

}  // namespace

std::string unit_of(std::span<const std::byte> cdr) {
  return Cursor(cdr).text().value_or(std::string());
}

std::vector<std::string> leading_texts(std::span<const std::byte> cdr, std::size_t count) {
  Cursor cursor(cdr);
  std::vector<std::string> texts(count);
  for (std::string& text : texts) {
    std::optional<std::string> next = cursor.text();
    if (!next) break;
    text = std::move(*next);
  }
  return texts;
}

std::optional<SampleStamp> stamp_of(std::span<const std::byte> cdr) {
  Cursor cursor(cdr);
  if (!cursor.text()) return std::nullopt;
  const std::optional<std::int64_t> interval = cursor.integer();
  const std::optional<std::int64_t> time_ns = cursor.integer();
  if (!interval || !time_ns) return std::nullopt;
  return SampleStamp{*interval, *time_ns};
}

}  // namespace mpm::idl
