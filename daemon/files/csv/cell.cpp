#include "daemon/files/csv/cell.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>

namespace mpm::files {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Besides empty, NaN and everything that begins with "bad": what historians write for no value.
constexpr std::array<std::string_view, 18> kNoValueWords = {
    "no data",     "i/o timeout", "null",      "none",       "na",        "n/a",
    "#n/a",        "-",           "no value",  "comm fail",  "scan off",  "scan timeout",
    "not connect", "shutdown",    "intf shut", "pt created", "configure", "arc off-line"};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool begins_with(std::string_view text, std::string_view word) {
  return same_word(text.substr(0, word.size()), word);
}

std::optional<double> parse_number(std::string_view text) {
  if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  // Too large or too small; from_chars does not say which. strtod gives infinity, or what is left.
  if (status == std::errc::result_out_of_range)
    return std::strtod(std::string(text).c_str(), nullptr);
  if (status != std::errc()) return std::nullopt;
  return value;
}

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](char x, char y) { return lower(x) == lower(y); });
}

std::optional<double> parse_value(std::string_view text, bool decimal_comma) {
  if (text.empty()) return kNoValue;
  if (const std::optional<double> number = parse_number(text)) return number;
  if (decimal_comma && std::count(text.begin(), text.end(), ',') == 1) {
    std::string with_point(text);
    std::replace(with_point.begin(), with_point.end(), ',', '.');
    if (const std::optional<double> number = parse_number(with_point)) return number;
  }
  const auto same = [text](std::string_view word) { return same_word(text, word); };
  if (begins_with(text, "bad") || std::any_of(kNoValueWords.begin(), kNoValueWords.end(), same))
    return kNoValue;
  return std::nullopt;
}

bool may_be_thousands(std::string_view text) {
  constexpr std::size_t kGroup = 3;  // digits
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) text.remove_prefix(1);
  const auto digits = [&text] {
    std::size_t count = 0;
    while (count < text.size() && text[count] >= '0' && text[count] <= '9') ++count;
    text.remove_prefix(count);
    return count;
  };
  if (text.empty() || text.front() == '0') return false;
  const std::size_t first = digits();
  if (first == 0 || first > kGroup || text.empty()) return false;
  while (!text.empty()) {
    if (text.front() != '.') return false;
    text.remove_prefix(1);
    if (digits() != kGroup) return false;
  }
  return true;
}

bool is_state(std::string_view text) {
  if (text.find('#') != std::string_view::npos) return true;  // 1.#QNAN, #DIV/0!
  const std::size_t first = text.find_first_not_of("+-");
  if (first == std::string_view::npos) return !text.empty();
  const std::size_t digit = text[first] == '.' || text[first] == ',' ? first + 1 : first;
  return digit >= text.size() || text[digit] < '0' || text[digit] > '9';
}

}  // namespace mpm::files
