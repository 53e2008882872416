#include "config/yaml_value.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <system_error>
#include <tuple>

#include "config/failure_text.hpp"
#include "config/suggest.hpp"
#include "config/yaml_text.hpp"
#include "core/text/printable.hpp"
#include "core/text/utf8.hpp"

namespace mpm::config {
namespace {

constexpr std::uintmax_t kLargestFile = 16U << 20U;
constexpr std::size_t kLongestShown = 40;
// No plant has more, in whatever unit, and its square is a number still.
constexpr double kLargest = 1e30;

std::string shown(std::string_view text) { return "'" + printable(text, kLongestShown) + "'"; }

std::string range_text(const Range& range) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  std::string text = "must be ";
  if (low) text += (range.low_open ? "> " : ">= ") + yaml_text(range.low);
  if (low && high) text += " and ";
  if (high) text += (range.high_open ? "< " : "<= ") + yaml_text(range.high);
  return text;
}

/// Values in a row, in one list, beyond what any key takes. As a tree each takes half a kilobyte.
constexpr std::size_t kMostInRow = 100001;

struct TooLong {
  YAML::Mark mark;
};

/// Listens to a parser only to learn where documents begin, and of endless lists.
class Scout : public YAML::EventHandler {
 public:
  [[nodiscard]] int documents() const { return documents_; }
  [[nodiscard]] const YAML::Mark& last_start() const { return last_start_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    ++documents_;
    last_start_ = mark;
    begin(mark);
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override { count(); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { count(); }
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count();
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    begin(mark);
  }
  void OnSequenceEnd() override { in_row_ = 0; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    begin(mark);
  }
  void OnMapEnd() override { in_row_ = 0; }

 private:
  void begin(const YAML::Mark& mark) {
    in_row_ = 0;
    list_ = mark;
  }
  void count() {
    if (++in_row_ > kMostInRow) throw TooLong{list_};
  }

  int documents_ = 0;
  std::size_t in_row_ = 0;
  YAML::Mark last_start_, list_;
};

/// YAML::Load drops whatever follows the first document without a word, and YAML::LoadAll does not
/// come back from some broken ones (0.7): look for a second document and stop there. Throws
/// TooLong.
void check_documents(const std::string& text, Report& report) {
  std::istringstream input(text);
  YAML::Parser parser(input);
  Scout scout;
  while (scout.documents() < 2 && parser.HandleNextDocument(scout)) {
  }
  if (scout.documents() > 1)
    report.add(Severity::kError, scout.last_start(), "",
               "text after the end of the document; give one document per file");
}

YAML::Mark mark_of(const std::string& text, std::size_t at) {
  const std::string_view before = std::string_view(text).substr(0, at);
  YAML::Mark mark;
  mark.pos = static_cast<int>(at);
  mark.line = static_cast<int>(std::count(before.begin(), before.end(), '\n'));
  mark.column = static_cast<int>(before.size() - (before.rfind('\n') + 1));
  return mark;
}

/// What is left of a number with a decimal comma, which parts two keys: `{gain: 4,05}`.
bool is_behind_comma(const YAML::detail::iterator_value& pair) {
  const std::string& key = pair.first.Scalar();
  return pair.second.IsNull() && !key.empty() &&
         key.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

YAML::Mark Report::mark_in(const YAML::Mark& start, std::string_view scalar,
                           std::size_t offset) const {
  const auto is_blank = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  const auto stands_for_none = [&](char c) {
    return is_blank(c) || c == '"' || c == '\'' || c == '\\';
  };
  auto at = static_cast<std::size_t>(std::max(start.pos, 0));
  if (at >= text_.size()) return start;
  if (text_[at] == '|' || text_[at] == '>') at = std::min(text_.find('\n', at), text_.size());
  for (std::size_t i = 0;; ++i) {
    if (i < scalar.size()) {
      const bool blank = is_blank(scalar[i]);
      while (at < text_.size() && text_[at] != scalar[i] && stands_for_none(text_[at]) &&
             !(blank && is_blank(text_[at])))
        ++at;
    }
    if (i >= offset || at >= text_.size()) return mark_of(text_, std::min(at, text_.size()));
    ++at;
  }
}

void Report::add(Severity severity, const YAML::Mark& mark, std::string key, std::string message) {
  const bool placed = !mark.is_null();
  findings_.push_back({file_, placed ? mark.line + 1 : 0, placed ? mark.column + 1 : 0, severity,
                       std::move(key), std::move(message)});
}

bool Report::has_error() const {
  return std::any_of(findings_.begin(), findings_.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

std::vector<Finding> Report::take() {
  std::stable_sort(findings_.begin(), findings_.end(), [](const Finding& a, const Finding& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  const auto same = [](const Finding& a, const Finding& b) {
    return std::tie(a.line, a.column, a.key, a.message) ==
           std::tie(b.line, b.column, b.key, b.message);
  };
  findings_.erase(std::unique(findings_.begin(), findings_.end(), same), findings_.end());
  return std::move(findings_);
}

std::string Value::kind() const {
  if (node_.IsMap()) return "a map of keys";
  if (node_.IsSequence()) return "a list";
  if (node_.IsScalar()) return shown(node_.Scalar());
  return "nothing";
}

void Value::error(std::string message) const {
  report_->add(Severity::kError, mark_, path_, std::move(message));
}

void Value::error_at(std::size_t offset, std::string message) const {
  report_->add(Severity::kError, report_->mark_in(mark_, node_.Scalar(), offset), path_,
               std::move(message));
}

void Value::warning(std::string message) const {
  report_->add(Severity::kWarning, mark_, path_, std::move(message));
}

bool Value::has_any_key(const std::vector<std::string>& keys) const {
  if (!node_.IsMap()) return false;
  for (const auto& pair : node_)
    if (pair.first.IsScalar() &&
        std::find(keys.begin(), keys.end(), pair.first.Scalar()) != keys.end())
      return true;
  return false;
}

std::optional<double> Value::number(const Range& range) const {
  if (!node_.IsScalar()) {
    error("must be a number, not " + kind());
    return std::nullopt;
  }
  std::string_view text = node_.Scalar();
  if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  static constexpr std::array kNotFinite = {".nan",  ".inf", "-.inf", ".NaN", ".Inf",
                                            "-.Inf", ".NAN", ".INF",  "-.INF"};
  const bool yaml_not_finite =
      std::find(kNotFinite.begin(), kNotFinite.end(), text) != kNotFinite.end();
  const bool whole = !text.empty() && end == text.data() + text.size();
  if (yaml_not_finite || (whole && (status == std::errc::result_out_of_range ||
                                    (status == std::errc() && !std::isfinite(value))))) {
    error("must be a finite number, not " + kind());
    return std::nullopt;
  }
  if (!whole || status != std::errc()) {
    error("must be a number, not " + kind());
    return std::nullopt;
  }
  const bool bounded = std::isfinite(range.low) && std::isfinite(range.high);
  if (std::abs(value) > kLargest && !bounded) {
    error("must be between -1e30 and 1e30, in whatever unit, not " + yaml_text(value));
    return std::nullopt;
  }
  if (!range.contains(value)) {
    error(range_text(range) + ", not " + yaml_text(value));
    return std::nullopt;
  }
  return value;
}

std::optional<Quantity> Value::quantity(const std::vector<std::string>& units,
                                        const Range& range) const {
  const std::string text = node_.IsScalar() ? node_.Scalar() : "";
  for (const std::string& unit : units) {
    if (text.size() <= unit.size() || !text.ends_with(unit)) continue;
    std::string rest = text.substr(0, text.size() - unit.size());
    while (!rest.empty() && rest.back() == ' ') rest.pop_back();
    if (rest.empty() || !(rest.back() == '.' || (rest.back() >= '0' && rest.back() <= '9')))
      continue;  // another word that ends so
    const std::optional<double> value =
        Value(YAML::Node(rest), mark_, path_, *report_).number(range);
    if (!value) return std::nullopt;
    return Quantity{*value, unit};
  }
  const std::optional<double> value = number(range);
  if (!value) return std::nullopt;
  return Quantity{*value, ""};
}

std::optional<int> Value::integer(const Range& range) const {
  const std::optional<double> value = number(range);
  if (!value) return std::nullopt;
  if (*value != std::floor(*value) || std::abs(*value) > std::numeric_limits<int>::max()) {
    error("must be a whole number, not " + kind());
    return std::nullopt;
  }
  return static_cast<int>(*value);
}

std::optional<bool> Value::boolean() const {
  if (node_.IsScalar()) {
    if (node_.Scalar() == "true") return true;
    if (node_.Scalar() == "false") return false;
  }
  error("must be true or false, not " + kind());
  return std::nullopt;
}

std::optional<std::string> Value::free_text() const {
  if (!node_.IsScalar()) {
    error("must be a text, not " + kind());
    return std::nullopt;
  }
  return node_.Scalar();
}

std::optional<std::string> Value::text(std::size_t longest) const {
  std::optional<std::string> value = free_text();
  if (!value) return std::nullopt;
  if (value->empty()) {
    error("must not be empty");
  } else if (value->size() > longest) {
    error("is longer than " + std::to_string(longest) + " bytes");
  } else if (printable(*value, std::string::npos) != *value) {
    error("must not hold control characters");
  } else {
    return value;
  }
  return std::nullopt;
}

std::vector<Value> Value::items() const {
  if (!node_.IsSequence()) return {*this};
  std::vector<Value> values;
  for (const YAML::Node& item : node_)
    values.emplace_back(item, item.Mark(), path_ + '[' + std::to_string(values.size()) + ']',
                        *report_);
  return values;
}

std::vector<double> Value::numbers(const Range& range) const {
  std::vector<double> values;
  for (const Value& item : items())
    if (const std::optional<double> value = item.number(range)) values.push_back(*value);
  return values;
}

Map Value::map(const std::vector<std::string>& known, std::string_view noun) const {
  return read_map(&known, noun);
}

Map Value::map_of_any() const { return read_map(nullptr, "key"); }

Map Value::read_map(const std::vector<std::string>* known, std::string_view noun) const {
  std::vector<Map::Entry> entries;
  if (node_.IsNull()) return {*this, {}};  // `monitor:` with nothing below
  if (!node_.IsMap()) {
    error("must be a map of keys, not " + kind());
    return {*this, {}};
  }
  for (const auto& pair : node_) {
    const YAML::Mark at = pair.first.Mark();
    if (!pair.first.IsScalar()) {
      Value(pair.first, at, path_, *report_).error("a key must be a word");
      continue;
    }
    const std::string& key = pair.first.Scalar();
    const std::string path = path_.empty() ? key : path_ + '.' + key;
    const Value key_at(pair.first, at, path, *report_);
    if (known != nullptr && std::find(known->begin(), known->end(), key) == known->end()) {
      key_at.error("unknown " + std::string(noun) +
                   (is_behind_comma(pair) ? "; a number has a decimal point, not a comma"
                                          : suggestion(key, *known)));
      continue;
    }
    const auto same = [&key](const Map::Entry& entry) { return entry.key == key; };
    const auto first = std::find_if(entries.begin(), entries.end(), same);
    if (first != entries.end()) {
      key_at.error("given twice; first in line " + std::to_string(first->key_at.line()));
      continue;
    }
    // An empty value has no mark worth showing: point to its key.
    const YAML::Mark value_at = pair.second.IsNull() ? at : pair.second.Mark();
    entries.push_back({key, key_at, Value(pair.second, value_at, path, *report_)});
  }
  return {*this, std::move(entries)};
}

const Map::Entry* Map::entry(std::string_view key) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [key](const Entry& entry) { return entry.key == key; });
  return found == entries_.end() ? nullptr : &*found;
}

const Value* Map::find(std::string_view key) const {
  const Entry* found = entry(key);
  return found == nullptr ? nullptr : &found->value;
}

const Value* Map::require(std::string_view key) const {
  const Value* value = find(key);
  if (value == nullptr) place_.error("`" + std::string(key) + "` is missing");
  return value;
}

/// What yaml-cpp says of a file, and in words what is usually wrong where it says that.
std::string syntax_error(const std::string& text, const YAML::Exception& error) {
  std::string message = "not valid YAML: " + error.msg;
  const auto at = static_cast<std::size_t>(std::max(0, error.mark.pos));
  const std::size_t line = text.rfind('\n', at) + 1;  // 0 where there is none
  const std::size_t begin = text.find_first_not_of(' ', line);
  if (begin != std::string::npos && text[begin] == '\t')
    return message + "; a tab begins this line, and only blanks may";
  namespace says = YAML::ErrorMsg;
  if (error.msg == says::END_OF_MAP || error.msg == says::END_OF_SEQ ||
      error.msg == says::MAP_VALUE)
    return message + "; this line or one above it begins too far left or right";
  return message;
}

std::optional<Value> parse_yaml(const std::string& text, Report& report) {
  const YAML::Mark start;
  if (const std::size_t at = find_invalid_utf8(text); at != std::string::npos) {
    report.add(Severity::kError, mark_of(text, at), "", "is no UTF-8; save the file as UTF-8");
    return std::nullopt;
  }
  if (const std::size_t at = text.find('\0'); at != std::string::npos) {
    report.add(Severity::kError, mark_of(text, at), "", "a zero byte: this is no text file");
    return std::nullopt;
  }
  try {
    check_documents(text, report);
    const YAML::Node root = YAML::Load(text);
    if (!root.IsDefined() || root.IsNull()) {
      report.add(Severity::kError, start, "", "the file is empty");
      return std::nullopt;
    }
    report.set_text(text);
    return Value(root, root.Mark(), "", report);
  } catch (const TooLong& list) {
    report.add(Severity::kError, list.mark, "", "has more values than anything here takes");
  } catch (const YAML::DeepRecursion& error) {  // which says "bad file"
    report.add(Severity::kError, error.mark, "", "is nested too deeply");
  } catch (const YAML::Exception& error) {
    report.add(Severity::kError, error.mark.is_null() ? start : error.mark, "",
               syntax_error(text, error));
  } catch (const std::exception& error) {
    report.add(Severity::kError, start, "", std::string("not valid YAML: ") + error.what());
  }
  return std::nullopt;
}

std::optional<std::string> read_text_file(const std::string& path, Report& report) {
  const YAML::Mark nowhere = YAML::Mark::null_mark();
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (status.type() == std::filesystem::file_type::not_found) {
    report.add(Severity::kError, nowhere, "", "no such file");
    return std::nullopt;
  }
  if (std::filesystem::is_directory(status)) {
    report.add(Severity::kError, nowhere, "", "is a folder, not a file");
    return std::nullopt;
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    report.add(Severity::kError, nowhere, "", "cannot be read: " + failure_text(errno));
    return std::nullopt;
  }
  std::string text;
  std::array<char, 65536> block{};
  while (file.read(block.data(), block.size()) || file.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > kLargestFile) {
      report.add(Severity::kError, nowhere, "", "is larger than 16 MB");
      return std::nullopt;
    }
  }
  if (file.bad()) {
    report.add(Severity::kError, nowhere, "", "cannot be read: " + failure_text(errno));
    return std::nullopt;
  }
  return text;
}

}  // namespace mpm::config
