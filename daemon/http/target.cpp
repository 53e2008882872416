#include "daemon/http/target.hpp"

namespace mpm::http {
namespace {

int digit_of(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
  return -1;
}

std::optional<std::string> decoded(std::string_view text, bool plus_is_space) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_space) {
      result += ' ';
      continue;
    }
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = digit_of(text[i + 1]), low = digit_of(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    result += static_cast<char>(16 * high + low);
    i += 2;
  }
  return result;
}

/// The text up to `end`, which is taken off with it.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return part;
}

}  // namespace

std::optional<Target> parse_target(std::string_view text) {
  text = text.substr(0, text.find('#'));
  std::string_view path = take_until(text, '?');
  if (path.empty() || path.front() != '/') return std::nullopt;
  path.remove_prefix(1);
  Target target;
  while (!path.empty()) {
    const auto part = decoded(take_until(path, '/'), false);
    if (!part) return std::nullopt;
    if (!part->empty()) target.path.push_back(*part);
  }
  while (!text.empty()) {
    std::string_view value = take_until(text, '&');
    const auto key = decoded(take_until(value, '='), true);
    const auto decoded_value = decoded(value, true);
    if (!key || !decoded_value) return std::nullopt;
    if (!key->empty()) target.query[*key] = *decoded_value;
  }
  return target;
}

}  // namespace mpm::http
