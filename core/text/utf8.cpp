#include "core/text/utf8.hpp"

#include <algorithm>
#include <cstdint>

namespace mpm {
namespace {

constexpr unsigned kLastAscii = 0x7F;
constexpr std::uint32_t kFirstSurrogate = 0xD800, kLastSurrogate = 0xDFFF, kLast = 0x10FFFF;

unsigned byte_of(char c) { return static_cast<unsigned char>(c); }

/// Of a character that begins so; 0 where none does.
std::size_t length_of(unsigned first) {
  if (first <= kLastAscii) return 1;
  if (first >> 5U == 0x6U) return 2;
  if (first >> 4U == 0xEU) return 3;
  return first >> 3U == 0x1EU ? 4 : 0;
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  if (text.empty()) return 0;
  const unsigned first = byte_of(text[0]);
  const std::size_t length = length_of(first);
  if (length <= 1) return length;
  if (length > text.size()) return 0;
  std::uint32_t code = first & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const unsigned next = byte_of(text[i]);
    if (next >> 6U != 0x2U) return 0;
    code = code << 6U | (next & 0x3FU);
  }
  static constexpr std::uint32_t kFirstOfLength[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= kFirstSurrogate && code <= kLastSurrogate;
  return code < kFirstOfLength[length] || surrogate || code > kLast ? 0 : length;
}

std::size_t find_invalid_utf8(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    if (byte_of(text[at]) <= kLastAscii) {
      ++at;
      continue;
    }
    const std::size_t length = utf8_length(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

std::string utf8_from_latin1(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (byte_of(c) <= kLastAscii) {
      result += c;
      continue;
    }
    result += static_cast<char>(0xC0U | byte_of(c) >> 6U);
    result += static_cast<char>(0x80U | (byte_of(c) & 0x3FU));
  }
  return result;
}

void make_blanks_plain(std::string& text) {
  constexpr std::string_view kBlanks[] = {"\u00A0", "\u2007", "\u2009", "\u202F"};
  std::size_t from = text.find_first_of("\xC2\xE2");
  if (from == std::string::npos) return;
  std::size_t to = from;
  while (from < text.size()) {
    const std::string_view rest = std::string_view(text).substr(from);
    std::size_t blank = 0;
    for (const std::string_view one : kBlanks)
      if (rest.starts_with(one)) blank = one.size();
    text[to++] = blank > 0 ? ' ' : text[from];
    from += std::max<std::size_t>(blank, 1);
  }
  text.resize(to);
}

}  // namespace mpm
