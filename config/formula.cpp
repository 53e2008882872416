#include "config/formula.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "config/characters.hpp"
#include "config/suggest.hpp"
#include "core/text/printable.hpp"

namespace mpm::config {
namespace {

constexpr std::size_t kDeepestFormula = 100;  // parentheses in each other
constexpr int kLargestUnitPower = 9;          // of a unit

/// Also of a letter that is no ASCII.
bool is_name_letter(char c) {
  return is_letter(c) || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n'; }

std::vector<std::string> function_names() {
  const mu::Parser parser;
  std::vector<std::string> names;
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  return names;
}

/// The expression as muParser takes it: v0, v1, ... for the tags.
struct Translation {
  std::string text;
  std::vector<std::size_t> origin;  // of each of its bytes, and of its end
  std::vector<Formula::Name> names;
  std::vector<std::string> tags;
};

/// Finds the tags, and refuses what muParser understands and an expression has no use for.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  Translation scan() {
    if (text_.size() > kLongestFormula)
      throw FormulaError(0, "is " + std::to_string(text_.size()) + " bytes long, at most " +
                                std::to_string(kLongestFormula) + " are read");
    while (at_ < text_.size()) scan_one();
    result_.origin.push_back(text_.size());
    return std::move(result_);
  }

 private:
  [[nodiscard]] char ahead(std::size_t by) const {
    return at_ + by < text_.size() ? text_[at_ + by] : '\0';
  }

  void copy(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      result_.text += is_blank(text_[at_]) ? ' ' : text_[at_];
      result_.origin.push_back(at_++);
    }
  }

  void scan_one() {
    const char c = text_[at_];
    if (is_name_letter(c))
      scan_word();
    else if (c == '{')
      scan_braces();
    else if (is_digit(c) || c == '.')
      scan_number();
    else
      scan_sign(c);
  }

  void scan_word() {
    std::size_t end = at_;
    while (end < text_.size() &&
           (is_name_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.'))
      ++end;
    const std::string word = text_.substr(at_, end - at_);
    std::size_t next = end;
    while (next < text_.size() && is_blank(text_[next])) ++next;
    if (next == text_.size() || text_[next] != '(') {
      add_tag(word, at_, end);
      return;
    }
    static const std::vector<std::string> functions = function_names();
    if (std::find(functions.begin(), functions.end(), word) == functions.end())
      throw FormulaError(at_,
                         "'" + printable(word) + "' is no function" + suggestion(word, functions));
    copy(next - at_);
    open(true);
  }

  void scan_braces() {
    const std::size_t end = text_.find('}', at_);
    if (end == std::string::npos) throw FormulaError(at_, "the brace is not closed");
    add_tag(text_.substr(at_ + 1, end - at_ - 1), at_ + 1, end + 1);
  }

  void add_tag(std::string tag, std::size_t begin, std::size_t end) {
    const auto found = std::find(result_.tags.begin(), result_.tags.end(), tag);
    const auto index = static_cast<std::size_t>(found - result_.tags.begin());
    if (found == result_.tags.end()) result_.tags.push_back(tag);
    for (const char c : "v" + std::to_string(index)) {
      result_.text += c;
      result_.origin.push_back(begin);
    }
    result_.names.push_back({std::move(tag), begin});
    at_ = end;
  }

  void scan_number() {
    std::size_t length = 0;
    while (is_digit(ahead(length)) || ahead(length) == '.') ++length;
    if (ahead(length) == 'e' || ahead(length) == 'E') {
      const std::size_t sign = ahead(length + 1) == '+' || ahead(length + 1) == '-' ? 1 : 0;
      if (is_digit(ahead(length + 1 + sign))) length += 1 + sign;
      while (is_digit(ahead(length))) ++length;
    }
    copy(length);
    if (is_name_letter(ahead(0)))
      throw FormulaError(at_, "a sign is missing behind the number, or braces around a tag");
  }

  void scan_sign(char c) {
    const std::string_view two = std::string_view(text_).substr(at_, 2);
    if (two == "==" || two == "!=" || two == "<=" || two == ">=" || two == "&&" || two == "||")
      return copy(2);
    if (c == '(') return open(false);
    if (c == ')' && !calls_.empty()) calls_.pop_back();
    if (c == ',' && (calls_.empty() || !calls_.back()))
      throw FormulaError(at_, "a comma parts the arguments of a function; the decimal sign is '.'");
    if (!is_blank(c) && std::string_view("+-*/^),<>?:").find(c) == std::string_view::npos)
      throw FormulaError(at_, "'" + printable(std::string(1, c)) + "' has no meaning here");
    copy(1);
  }

  void open(bool of_a_function) {
    calls_.push_back(of_a_function);
    if (calls_.size() > kDeepestFormula)
      throw FormulaError(
          at_, "more than " + std::to_string(kDeepestFormula) + " parentheses in each other");
    copy(1);
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::vector<bool> calls_;  // open parentheses: whether of a function
  Translation result_;
};

std::string what_is_wrong(const mu::ParserError& error) {
  switch (error.GetCode()) {
    case mu::ecEMPTY_EXPRESSION:
      return "the expression is empty";
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends where something is to follow";
    case mu::ecMISSING_PARENS:
      return "a parenthesis is not closed";
    case mu::ecUNEXPECTED_PARENS:
      return "a parenthesis is out of place";
    case mu::ecTOO_MANY_PARAMS:
      return "'" + error.GetToken() + "' has too many arguments";
    case mu::ecTOO_FEW_PARAMS:
      return "'" + error.GetToken() + "' has too few arguments";
    case mu::ecMISSING_ELSE_CLAUSE:
      return "'?' without ':'";
    case mu::ecMISPLACED_COLON:
      return "':' without '?'";
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_FUN:
      return "a sign such as + or * is missing before this";
    case mu::ecUNEXPECTED_OPERATOR:
      return "a tag or a number is missing before this";
    default:
      return "cannot be read from here on";
  }
}

}  // namespace

struct Formula::Parser {
  std::vector<double> values;  // muParser keeps their addresses
  mu::Parser parser;
};

Formula::Formula(const std::string& text) : parser_(std::make_unique<Parser>()) {
  Translation translation = Scanner(text).scan();
  names_ = std::move(translation.names);
  tags_ = std::move(translation.tags);
  parser_->values.assign(tags_.size(), 1.0);
  mu::Parser& parser = parser_->parser;
  parser.EnableOptimizer(false);  // what is written is what is computed, and what has units
  try {
    for (std::size_t i = 0; i < tags_.size(); ++i)
      parser.DefineVar("v" + std::to_string(i), &parser_->values[i]);
    parser.SetExpr(translation.text);
    static_cast<void>(parser.Eval());  // reads it
  } catch (const mu::ParserError& error) {
    const std::size_t end = translation.origin.size() - 1;
    const auto at = error.GetPos() < 0 ? 0 : static_cast<std::size_t>(error.GetPos());
    throw FormulaError(translation.origin[std::min(at, end)], what_is_wrong(error));
  }
}

Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;
Formula& Formula::operator=(Formula&&) noexcept = default;

double Formula::evaluate(std::span<const double> values) const {
  std::copy(values.begin(), values.end(), parser_->values.begin());
  return parser_->parser.Eval();
}

// muParser's program is in the order of the text, so its variables are the names one by one.
std::optional<EngineeringUnit> Formula::unit(
    std::span<const std::optional<EngineeringUnit>> units) const {
  struct Term {
    std::optional<EngineeringUnit> unit;
    std::optional<double> number;
    std::size_t at = 0;
  };
  std::vector<Term> stack;
  std::size_t name = 0;
  const mu::ParserByteCode& program = parser_->parser.GetByteCode();
  for (std::size_t i = 0; i < program.GetSize(); ++i) {
    const mu::SToken& token = program.GetBase()[i];
    if (token.Cmd == mu::cmVAR) {
      const auto tag = static_cast<std::size_t>(token.Val.ptr - parser_->values.data());
      stack.push_back({units[tag], std::nullopt, names_[name++].at});
      continue;
    }
    if (token.Cmd == mu::cmVAL) {
      stack.push_back({std::nullopt, token.Val.data2, stack.empty() ? 0 : stack.back().at});
      continue;
    }
    if (token.Cmd == mu::cmFUNC) {  // a number of arguments that is not fixed is negative
      const auto arguments = static_cast<std::size_t>(std::abs(token.Fun.argc));
      if (arguments > stack.size()) return std::nullopt;
      const std::size_t at = arguments > 0 ? stack[stack.size() - arguments].at : 0;
      stack.resize(stack.size() - arguments);
      stack.push_back({std::nullopt, std::nullopt, at});
      continue;
    }
    if (token.Cmd == mu::cmEND) break;
    if (token.Cmd > mu::cmPOW || stack.size() < 2) return std::nullopt;  // of ? : and && ||
    const Term right = std::move(stack.back());
    stack.pop_back();
    Term& left = stack.back();
    left.number.reset();
    switch (token.Cmd) {
      case mu::cmADD:
      case mu::cmSUB:
        if (left.unit && right.unit && *left.unit != *right.unit)
          throw FormulaError(
              right.at, std::string(token.Cmd == mu::cmADD ? "adds " : "subtracts ") +
                            to_string(*right.unit) + (token.Cmd == mu::cmADD ? " to " : " from ") +
                            to_string(*left.unit));
        if (!left.unit) left.unit = right.unit;
        break;
      case mu::cmMUL:
        left.unit =
            left.unit && right.unit ? std::optional(*left.unit * *right.unit) : std::nullopt;
        break;
      case mu::cmDIV:
        left.unit =
            left.unit && right.unit ? std::optional(*left.unit / *right.unit) : std::nullopt;
        break;
      case mu::cmPOW: {
        const double power = right.number.value_or(0.5);
        left.unit = left.unit && power == std::round(power) && std::abs(power) <= kLargestUnitPower
                        ? std::optional(left.unit->to_the(static_cast<int>(power)))
                        : std::nullopt;
        break;
      }
      default:
        left.unit.reset();
    }
  }
  return stack.size() == 1 ? stack.front().unit : std::nullopt;
}

}  // namespace mpm::config
