#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace mpm {

/// Writes the state of objects as bytes, or reads it back. A class lists what the samples change in
/// `archive(Archive&)`, which serves both ways; what its constructor makes of the configuration it
/// does not list (tests/style/check_archive.py). Bytes are those of this machine; doubles keep all
/// their bits.
///
/// Reading throws std::runtime_error where the bytes do not fit what construction has made, or end
/// too early; it takes no more memory than the bytes stand for. Numbers that others would count on
/// are read with `within`: whatever the bytes say, the object may be wrong but not broken.
class Archive {
 public:
  /// What a writing archive throws once it was told to stop; nothing but its bytes has changed.
  struct Stopped {};

  /// Appends to `out`. `stop`: asked before every megabyte; empty: never.
  explicit Archive(std::vector<std::byte>& out, std::function<bool()> stop = nullptr)
      : out_(&out), stop_(std::move(stop)) {}
  explicit Archive(std::span<const std::byte> in) : in_(in) {}

  [[nodiscard]] bool reads() const { return out_ == nullptr; }
  /// Bytes that have not been read.
  [[nodiscard]] std::size_t left() const { return in_.size(); }

  /// One after the other: numbers, texts, lists whose length construction fixed, objects with a
  /// listing.
  template <class... Members>
  void operator()(Members&... members) {
    (one(members), ...);
  }
  /// A number or enumerator that is an index, or counts towards a limit.
  template <class T>
  void within(T& number, std::type_identity_t<T> low, std::type_identity_t<T> high) {
    auto whole = static_cast<std::int64_t>(number);
    bytes(&whole, sizeof whole);
    require(static_cast<std::int64_t>(low) <= whole && whole <= static_cast<std::int64_t>(high),
            "a number beyond its limits");
    number = static_cast<T>(whole);
  }
  /// A time, which may be any.
  void time(std::int64_t& time_ns) { bytes(&time_ns, sizeof time_ns); }
  void doubles(double* values, std::size_t count) { bytes(values, count * sizeof(double)); }
  /// A list of any length; `fresh`: what its elements are read into.
  template <class T>
  void varying(std::vector<T>& list, const T& fresh = T()) {
    const std::size_t length = varying_length(list.size());
    if (reads()) list.clear();
    for (std::size_t i = 0; i < length; ++i) {
      if (reads()) list.push_back(fresh);
      one(list[i]);
    }
  }
  /// A length that construction fixed.
  void length(std::size_t fixed);
  /// Of what was read; nothing happens where it was written.
  void require(bool holds, const char* what) const {
    if (!holds && reads()) refuse(what);
  }

 private:
  template <class T>
  void one(T& member) {
    if constexpr (requires { member.archive(*this); })
      member.archive(*this);
    else
      item(member);
  }

  void item(double& number) { bytes(&number, sizeof number); }
  void item(std::uint64_t& number) { bytes(&number, sizeof number); }
  void item(unsigned& number) { bytes(&number, sizeof number); }
  /// No further than sums and differences of two can be told.
  void item(std::int64_t& number) { counted(number); }
  void item(int& number) { counted(number); }
  template <class T>
  void counted(T& number) {
    constexpr T kFarthest = std::numeric_limits<T>::max() / 4;
    bytes(&number, sizeof number);
    require(-kFarthest <= number && number <= kFarthest, "a count beyond all counting");
  }
  void item(bool& flag);
  void item(std::string& text);
  void item(std::vector<double>& list) {
    length(list.size());
    doubles(list.data(), list.size());
  }
  void item(std::vector<bool>& list);
  template <class T>
  void item(std::vector<T>& list) {
    length(list.size());
    for (T& each : list) one(each);
  }
  template <class T, std::size_t count>
  void item(std::array<T, count>& list) {
    for (T& each : list) one(each);
  }
  template <class T>
  void item(std::optional<T>& perhaps) {
    bool there = perhaps.has_value();
    item(there);
    if (!there) return perhaps.reset();
    if (!perhaps) perhaps.emplace();
    one(*perhaps);
  }
  template <int rows, int columns, int options>
  void item(Eigen::Matrix<double, rows, columns, options>& matrix) {
    length(static_cast<std::size_t>(matrix.rows()));
    length(static_cast<std::size_t>(matrix.cols()));
    doubles(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }

  void bytes(void* memory, std::size_t count);
  void append(const std::byte* from, std::size_t count);
  [[nodiscard]] std::size_t varying_length(std::size_t length);
  [[noreturn]] void refuse(const std::string& what) const;

  std::vector<std::byte>* out_ = nullptr;
  std::function<bool()> stop_;
  std::size_t before_look_ = 0;  // bytes
  std::span<const std::byte> in_;
};

/// The state of all objects as bytes. Changes none of them.
template <class... Objects>
[[nodiscard]] std::vector<std::byte> put_away(const Objects&... objects) {
  std::vector<std::byte> bytes;
  Archive archive(bytes);
  archive(const_cast<Objects&>(objects)...);  // a listing serves both ways
  return bytes;
}

/// Brings objects that were constructed of the same configuration to the state that `put_away` saw,
/// in the same order. Where it throws std::runtime_error, some are half read: throw all away.
template <class... Objects>
void take_back(std::span<const std::byte> bytes, Objects&... objects) {
  Archive archive(bytes);
  archive(objects...);
  archive.require(archive.left() == 0, "more bytes than belong there");
}

}  // namespace mpm
