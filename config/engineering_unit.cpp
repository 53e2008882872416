#include "config/engineering_unit.hpp"

#include <cstdlib>

#include "config/characters.hpp"

namespace mpm::config {
namespace {

constexpr int kDeepest = 20;       // parentheses in each other
constexpr int kLargestPower = 99;  // of a word

/// Of a unit's word: letters of any script, %, degree signs.
bool is_word(char c) {
  return is_letter(c) || c == '%' || c == '_' || c == '\'' || static_cast<unsigned char>(c) >= 0x80;
}

constexpr std::string_view kMiddleDot = "\xc2\xb7";

class UnitReader {
 public:
  using Unit = EngineeringUnit;
  using Word = Unit (*)(std::string_view word);

  UnitReader(std::string_view text, Word word) : text_(text), word_(word) {}

  std::optional<Unit> read() {
    std::optional<Unit> unit = product(0);
    return at_ == text_.size() ? unit : std::nullopt;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(std::string_view sign) {
    if (text_.substr(at_, sign.size()) != sign) return false;
    at_ += sign.size();
    return true;
  }

  std::optional<Unit> product(int depth) {
    if (depth > kDeepest) return std::nullopt;
    skip_blanks();
    std::optional<Unit> result = factor(depth);
    while (result) {
      skip_blanks();
      if (at_ == text_.size() || text_[at_] == ')') return result;
      const bool divides = take("/");
      if (!divides && !take("*") && !take(".")) static_cast<void>(take(kMiddleDot));
      skip_blanks();
      const std::optional<Unit> next = factor(depth);
      if (!next) return std::nullopt;
      result = divides ? *result / *next : *result * *next;
    }
    return result;
  }

  std::optional<Unit> factor(int depth) {
    std::optional<Unit> unit;
    if (take("(")) {
      unit = product(depth + 1);
      if (!unit || !take(")")) return std::nullopt;
    } else if (take("1") || take("-")) {
      return Unit();
    } else {
      const std::size_t begin = at_;
      while (at_ < text_.size() && is_word(text_[at_]) &&
             text_.substr(at_, kMiddleDot.size()) != kMiddleDot)
        ++at_;
      if (at_ == begin) return std::nullopt;
      unit = word_(text_.substr(begin, at_ - begin));
    }
    const std::optional<int> power = read_power();
    return power ? std::optional(unit->to_the(*power)) : std::nullopt;
  }

  std::optional<int> read_power() {
    const bool raised = take("^");
    const bool negative = raised && take("-");
    const std::size_t begin = at_;
    int power = 0;
    while (at_ < text_.size() && is_digit(text_[at_])) {
      power = 10 * power + (text_[at_++] - '0');
      if (power > kLargestPower) return std::nullopt;
    }
    if (at_ == begin) return raised ? std::nullopt : std::optional(1);
    return negative ? -power : power;
  }

  std::string_view text_;
  Word word_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<EngineeringUnit> EngineeringUnit::parse(std::string_view text) {
  return UnitReader(text,
                    [](std::string_view word) {
                      EngineeringUnit unit;
                      unit.powers_.emplace(word, 1);
                      return unit;
                    })
      .read();
}

EngineeringUnit EngineeringUnit::to_the(int power) const {
  EngineeringUnit result;
  if (power == 0) return result;
  for (const auto& [word, of_word] : powers_) result.powers_[word] = of_word * power;
  return result;
}

EngineeringUnit operator*(const EngineeringUnit& a, const EngineeringUnit& b) {
  EngineeringUnit result = a;
  for (const auto& [word, power] : b.powers_)
    if ((result.powers_[word] += power) == 0) result.powers_.erase(word);
  return result;
}

EngineeringUnit operator/(const EngineeringUnit& a, const EngineeringUnit& b) {
  return a * b.to_the(-1);
}

std::string to_string(const EngineeringUnit& unit) {
  std::string above, below;
  int divisors = 0;
  for (const auto& [word, power] : unit.powers_) {
    std::string& side = power > 0 ? above : below;
    divisors += power < 0 ? 1 : 0;
    side += (side.empty() ? "" : " ") + word +
            (std::abs(power) > 1 ? std::to_string(std::abs(power)) : "");
  }
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (divisors > 1 ? "(" + below + ")" : below);
}

}  // namespace mpm::config
