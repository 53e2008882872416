#include "daemon/report/terminal/terminal_text.hpp"

#include <algorithm>

namespace mpm::report {
namespace {

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }

/// Where character `index` begins.
std::size_t offset_of(std::string_view text, std::size_t index) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (begins_character(text[i]) && index-- == 0) return i;
  return text.size();
}

const char* code_of(Tint tint) {
  switch (tint) {
    case Tint::kBold:
      return "\x1b[1m";
    case Tint::kGrey:
      return "\x1b[90m";
    case Tint::kGreen:
      return "\x1b[32m";
    case Tint::kRed:
      return "\x1b[1;31m";
    case Tint::kPlain:
      break;
  }
  return "";
}

}  // namespace

std::string Layout::paint(Tint tint, const std::string& text) const {
  return color && tint != Tint::kPlain ? code_of(tint) + text + "\x1b[0m" : text;
}

std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

std::string padded(std::string text, std::size_t width) {
  text.append(width - std::min(width, columns_of(text)), ' ');
  return text;
}

std::string shortened(const std::string& text, std::size_t width) {
  const std::size_t all = columns_of(text);
  if (all <= width) return text;
  constexpr std::string_view kDots = "..";
  const std::size_t kept = width - kDots.size();
  const std::size_t end = kept / 2;
  return text.substr(0, offset_of(text, kept - end)).append(kDots) +
         text.substr(offset_of(text, all - end));
}

std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string lines, line(indent, ' ');
  bool empty = true;
  for (std::size_t from = 0; from < text.size();) {
    std::size_t end = text.find(' ', from);
    if (end != std::string::npos && text.compare(end, 2, " %") == 0) end = text.find(' ', end + 1);
    end = std::min(end, text.size());
    const std::string word = text.substr(from, end - from);
    if (!empty && columns_of(line) + 1 + columns_of(word) > width) {
      lines += line + '\n';
      line = std::string(indent + 2, ' ');
      empty = true;
    }
    line += (empty ? "" : " ") + word;
    empty = false;
    from = end + 1;
  }
  return lines + line + '\n';
}

std::string sentences_wrapped(const std::string& text, std::size_t width) {
  std::string lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    const bool row = line.find("  ", indent) != std::string::npos;
    lines += row || columns_of(line) <= width ? line + '\n'
                                              : wrapped(line.substr(indent), indent, width);
  }
  return lines;
}

}  // namespace mpm::report
