#pragma once

#include <cstddef>
#include <string_view>

namespace mpm::files {

/// Takes leading pieces off a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  bool take(char c) {
    if (peek() != c || rest_.empty()) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    if (rest_.substr(0, word.size()) != word) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  void take_blanks() {
    while (peek() == ' ') rest_.remove_prefix(1);
  }
  /// `most` of them at most.
  std::string_view take_digits(std::size_t most = std::string_view::npos) {
    return take_while([](char c) { return is_digit(c); }, most);
  }
  /// Letters of any language: ASCII, and whatever UTF-8 writes with more than one byte.
  std::string_view take_letters() {
    return take_while([](char c) { return is_letter(c); }, std::string_view::npos);
  }
  /// A number of exactly `count` digits, or -1.
  int take_number(std::size_t count) {
    const std::string_view before = rest_;
    const int value = take_number(count, count);
    if (value < 0) rest_ = before;
    return value;
  }
  /// A number of `least` to `most` (at most 9) digits, or -1.
  int take_number(std::size_t least, std::size_t most) {
    const std::string_view digits = take_digits(most);
    if (digits.size() < least) return -1;
    int value = 0;
    for (const char c : digits) value = 10 * value + (c - '0');
    return value;
  }

  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           (static_cast<unsigned char>(c) > 127);
  }

 private:
  template <class Is>
  std::string_view take_while(Is is, std::size_t most) {
    std::size_t count = 0;
    while (count < rest_.size() && count < most && is(rest_[count])) ++count;
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::string_view rest_;
};

}  // namespace mpm::files
