#include "config/yaml_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "config/characters.hpp"

namespace mpm::config {
namespace {

bool is_plain_word(const std::string& text) {
  static constexpr std::array<std::string_view, 9> kReserved = {
      "true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  if (text.empty() || !is_letter(text.front())) return false;
  std::string lower;
  for (const char c : text) {
    if (!is_letter(c) && !is_digit(c) && c != '_' && c != '.' && c != '-') return false;
    lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return std::find(kReserved.begin(), kReserved.end(), lower) == kReserved.end();
}

template <class Values>
std::string list_text(const Values& values) {
  std::string text = "[";
  for (const auto& value : values) text += (text.size() > 1 ? ", " : "") + yaml_text(value);
  return text + "]";
}

}  // namespace

std::string yaml_text(double value) {
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  std::array<char, 40> buffer{};
  char* const end = buffer.data() + buffer.size();
  // The shortest form of 100000 is 1e+05, which nobody writes.
  const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
  const auto result = whole ? std::to_chars(buffer.data(), end, value, std::chars_format::fixed)
                            : std::to_chars(buffer.data(), end, value);
  return {buffer.data(), result.ptr};
}

std::string yaml_text(int value) { return std::to_string(value); }

std::string yaml_text(bool value) { return value ? "true" : "false"; }

std::string yaml_text(const std::string& text) {
  if (is_plain_word(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\x%02x", static_cast<unsigned>(c));
      quoted += escape.data();
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string yaml_text(const std::vector<double>& values) { return list_text(values); }

std::string yaml_text(const std::vector<std::string>& values) { return list_text(values); }

std::string yaml_text(const Eigen::MatrixXd& matrix) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    text += i > 0 ? ", [" : "[";
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      text += (j > 0 ? ", " : "") + yaml_text(matrix(i, j));
    text += "]";
  }
  return text + "]";
}

}  // namespace mpm::config
