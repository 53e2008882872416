#include "config/formula.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <locale>

#include "tests/allocation_counter.hpp"

namespace mpm::config {
namespace {

double value(const std::string& text, const std::vector<double>& values = {}) {
  return Formula(text).evaluate(values);
}

/// `at: message` of an expression that cannot be read.
std::string refusal(const std::string& text) {
  try {
    const Formula formula(text);
  } catch (const FormulaError& error) {
    return std::to_string(error.at) + ": " + error.what();
  }
  return "read";
}

/// The result's unit for those of the tags in their order; "" = not given.
std::string unit_of(const std::string& text, const std::vector<std::string>& units) {
  std::vector<std::optional<EngineeringUnit>> parsed;
  for (const std::string& unit : units)
    parsed.push_back(unit.empty() ? std::nullopt : EngineeringUnit::parse(unit));
  try {
    const std::optional<EngineeringUnit> unit = Formula(text).unit(parsed);
    return unit ? to_string(*unit) : "unknown";
  } catch (const FormulaError& error) {
    return std::to_string(error.at) + ": " + error.what();
  }
}

struct DecimalComma : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

TEST_CASE("an expression is computed as it is written") {
  CHECK(value("flow * (T_supply - T_return)", {2.0, 80.0, 50.5}) == 59.0);
  CHECK(value("2 + 3 * 4 ^ 2 / 8 - -1") == 9.0);
  CHECK(value("2 ^ 3 ^ 2") == 512.0);  // from the right
  CHECK(value("-x ^ 2", {3.0}) == -9.0);
  CHECK(value("a > b && b >= 1 ? max(a, b, 1.5e1) : 0", {2.0, 1.0}) == 15.0);
  CHECK(value("sqrt(x) + ln(1) + log10(1000)", {16.0}) == Approx(7.0));
  CHECK(std::isinf(value("1 / x", {0.0})));
  CHECK(std::isnan(value("sqrt(x)", {-1.0})));
}

TEST_CASE("tags stand as they are if they look like names, else in braces") {
  const Formula formula("FIC101.PV + {FIC-101.PV} * {K\xc3\xbchler 2} - FIC101.PV + T\xc3\xbcr");
  CHECK(formula.tags() ==
        std::vector<std::string>{"FIC101.PV", "FIC-101.PV", "K\xc3\xbchler 2", "T\xc3\xbcr"});
  REQUIRE(formula.names().size() == 5);
  CHECK(formula.names()[1].at == 13);
  CHECK(formula.evaluate(std::vector{7.0, 2.0, 3.0, 1.0}) == 7.0);
  CHECK(value("{max} + max(1, {max})", {3.0}) == 6.0);  // a tag called as a function
}

TEST_CASE("what cannot be read is told at its place") {
  CHECK(refusal("") == "0: the expression is empty");
  CHECK(refusal("a +") == "3: the expression ends where something is to follow");
  CHECK(refusal("(a + b") == "6: a parenthesis is not closed");
  CHECK(refusal("a + b)") == "5: a parenthesis is out of place");
  CHECK(refusal("a {b c}") == "3: a sign such as + or * is missing before this");
  CHECK(refusal("a * {b") == "4: the brace is not closed");
  CHECK(refusal("a + foo(b)").find("4: 'foo' is no function") == 0);
  CHECK(refusal("1 + sqr(b)").find("(did you mean 'sqrt'?)") != std::string::npos);
  CHECK(refusal("0,5 * a").find("1: a comma parts the arguments of a function") == 0);
  CHECK(refusal("2a") == "1: a sign is missing behind the number, or braces around a tag");
  CHECK(refusal("a = 5") == "2: '=' has no meaning here");
  CHECK(refusal("a \"text\"") == "2: '\"' has no meaning here");
  CHECK(refusal("sin(a, b)").find("'sin' has too many arguments") != std::string::npos);
  CHECK(refusal("a ? b") == "0: '?' without ':'");
  CHECK(refusal("1.2.3 * a") != "read");
  CHECK(refusal("1e400 * a") != "read");
}

TEST_CASE("hostile expressions are refused with one clear sentence") {
  CHECK(refusal(std::string(1'000'000, '(')) == "0: is 1000000 bytes long, at most 4000 are read");
  const std::string open(1500, '('), close(1500, ')');
  CHECK(refusal(open + "a" + close) == "100: more than 100 parentheses in each other");
  CHECK(refusal(std::string(3999, '-') + "a") != "read");
  for (const std::string piece :
       {"a+", "a?1:", "a^", "{a}", "sin(", "!", "a,", "max(a,", "?", ":"}) {
    std::string text;
    while (text.size() + piece.size() < kLongestFormula) text += piece;
    CAPTURE(piece);
    CHECK(refusal(text + "a").size() < 200);  // whatever it is: it comes back
  }
}

TEST_CASE("numbers are read and computed with a point, whatever the locale") {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  CHECK(value("1234.5 * x", {2.0}) == 2469.0);
  std::locale::global(before);
}

TEST_CASE("evaluating allocates nothing") {
  const Formula formula("max(flow, 0) * ({T-1} - T2) > 1 ? flow ^ 2 : sqrt(T2)");
  const std::vector<double> values = {2.0, 80.0, 50.0};
  double sum = formula.evaluate(values);
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 1000; ++i) sum += formula.evaluate(values);
  CHECK(test::allocation_count() == before);
  CHECK(sum == 4004.0);
}

TEST_CASE("units go through sums, products and powers, as far as they are known") {
  CHECK(unit_of("flow * (a - b)", {"m3/h", "K", "K"}) == "K m3/h");
  CHECK(unit_of("flow * a / flow", {"kg/s", "K"}) == "K");
  CHECK(unit_of("(a + b) ^ 2", {"m", "m"}) == "m2");
  CHECK(unit_of("flow * (a - b)", {"m3/h", "K", "degC"}) == "12: subtracts degC from K");
  CHECK(unit_of("a + b * c", {"m3/h", "m3", "1/h"}) == "m3/h");
  CHECK(unit_of("a + b / c", {"m3/h", "m3", "1/h"}) == "4: adds h m3 to m3/h");
  // A number may have any unit, and so may what a function gives or a tag without one.
  CHECK(unit_of("4.19 * flow * (a - b)", {"kg/s", "K", "K"}) == "unknown");
  CHECK(unit_of("a + 273.15", {"K"}) == "K");
  CHECK(unit_of("a - b", {"K", ""}) == "K");
  CHECK(unit_of("a + exp(b)", {"K", "m"}) == "K");
  CHECK(unit_of("a > 0 ? a : b", {"K", "m"}) == "unknown");
  CHECK(unit_of("a ^ 0.5", {"m2"}) == "unknown");
}

}  // namespace
}  // namespace mpm::config
