#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/engineering_unit.hpp"

namespace mpm::config {

/// What is wrong with an expression.
struct FormulaError : std::runtime_error {
  FormulaError(std::size_t at_byte, const std::string& message)
      : std::runtime_error(message), at(at_byte) {}
  std::size_t at;  ///< bytes from its beginning
};

inline constexpr std::size_t kLongestFormula = 4000;  ///< bytes

/// An arithmetic expression of tags, such as `flow * (T_supply - {TI-102.PV})`. Tags of letters,
/// digits, `_` and `.` stand as they are, all others in braces. Operators + - * / ^, comparisons,
/// && || and `a ? b : c`; the functions of muParser, which reads and evaluates it. Independent of
/// the locale: the decimal sign is a point.
class Formula {
 public:
  struct Name {
    std::string tag;
    std::size_t at = 0;  ///< bytes from the beginning of the expression
  };

  /// Throws FormulaError where it cannot be read, is longer than kLongestFormula or nested too
  /// deep.
  explicit Formula(const std::string& text);
  ~Formula();
  Formula(Formula&&) noexcept;
  Formula& operator=(Formula&&) noexcept;

  /// Every tag where it stands, in the order of the text.
  [[nodiscard]] const std::vector<Name>& names() const { return names_; }
  /// Each tag once, in the order in which it first occurs.
  [[nodiscard]] const std::vector<std::string>& tags() const { return tags_; }

  /// `values`: of `tags()`. Whatever is not defined (1/0, sqrt(-1)) gives what is not finite.
  /// Allocates nothing.
  [[nodiscard]] double evaluate(std::span<const double> values) const;

  /// The unit of the result for the units of `tags()`; nothing where one that it depends on is not
  /// known. A number may stand for a quantity of any unit, and what a function gives is not known.
  /// Throws FormulaError where + or - join two units that are not the same.
  [[nodiscard]] std::optional<EngineeringUnit> unit(
      std::span<const std::optional<EngineeringUnit>> units) const;

 private:
  struct Parser;

  std::vector<Name> names_;
  std::vector<std::string> tags_;
  std::unique_ptr<Parser> parser_;
};

}  // namespace mpm::config
