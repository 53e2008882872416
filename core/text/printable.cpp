#include "core/text/printable.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

#include "core/text/utf8.hpp"

namespace mpm {
namespace {

std::string byte_escape(char c) {
  if (c == '\n') return "\\n";
  if (c == '\r') return "\\r";
  if (c == '\t') return "\\t";
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "\\x%02x",
                static_cast<unsigned>(static_cast<unsigned char>(c)));
  return text.data();
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

/// Characters of two and three bytes that a terminal takes for a command: the second set of control
/// characters, ends of lines and paragraphs, marks and brackets of direction.
bool is_command(std::uint32_t code) {
  return (code >= 0x80 && code <= 0x9F) || code == 0x61C || code == 0x200E || code == 0x200F ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

std::uint32_t code_of(std::string_view character) {
  const auto bits = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(character[i]) & 0x3FU);
  };
  if (character.size() == 2) return (bits(0) & 0x1FU) << 6U | bits(1);
  if (character.size() == 3) return (bits(0) & 0xFU) << 12U | bits(1) << 6U | bits(2);
  return 0;  // those of four bytes do no harm
}

std::string shown(std::string_view character) {
  const std::uint32_t code = code_of(character);
  if (!is_command(code)) return std::string(character);
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "\\u{%x}", static_cast<unsigned>(code));
  return text.data();
}

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at));
    const bool as_it_is = length == 1 && !is_control(text[at]);
    const std::string piece = as_it_is     ? std::string(1, text[at])
                              : length < 2 ? byte_escape(text[at])
                                           : shown(text.substr(at, length));
    if (result.size() + piece.size() > longest) return result + "...";
    result += piece;
    at += length == 0 ? 1 : length;
  }
  return result;
}

}  // namespace mpm
