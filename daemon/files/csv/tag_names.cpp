#include "daemon/files/csv/tag_names.hpp"

#include <algorithm>
#include <array>

#include "core/text/utf8.hpp"
#include "daemon/files/csv/cell.hpp"

namespace mpm::files {
namespace {

constexpr std::size_t kLongestName = 512;  // of names that are looked into
constexpr std::size_t kMostForms = 64;

constexpr std::array<std::string_view, 6> kValueWords = {"pv", "value",        "val",
                                                         "cv", "currentvalue", "wert"};
/// In brackets behind a tag they say that the column is not the tag's value.
constexpr std::array<std::string_view, 32> kOtherWords = {
    "sp",      "set-point", "setpoint",  "set point",  "sollwert", "sv",     "op",
    "out",     "output",    "stellwert", "mode",       "auto",     "manual", "quality",
    "status",  "state",     "qual",      "confidence", "min",      "max",    "minimum",
    "maximum", "std",       "stddev",    "range",      "count",    "alarm",  "hi",
    "lo",      "limit",     "forecast",  "predicted"};

template <std::size_t n>
bool is_one_of(const std::array<std::string_view, n>& words, std::string_view text) {
  return std::any_of(words.begin(), words.end(),
                     [text](std::string_view word) { return same_word(word, text); });
}

std::string_view without_blanks_behind(std::string_view text) {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// `Q1 [degC]` and `Q1 (PV)` are `Q1`; other names stay.
std::string_view without_bracket(std::string_view name) {
  if (name.empty() || (name.back() != ']' && name.back() != ')')) return name;
  const std::size_t open = name.rfind(name.back() == ']' ? '[' : '(');
  if (open == std::string_view::npos || open == 0) return name;
  if (is_one_of(kOtherWords, name.substr(open + 1, name.size() - open - 2))) return name;
  return without_blanks_behind(name.substr(0, open));
}

std::string_view without_word(std::string_view name) {
  const std::size_t cut = name.find_last_of("./|: ");
  if (cut == std::string_view::npos || cut == 0) return name;
  if (!is_one_of(kValueWords, name.substr(cut + 1))) return name;
  return without_blanks_behind(name.substr(0, cut));
}

/// What stands behind a server, `[provider]` or the first folder.
std::string_view behind_first_part(std::string_view name) {
  if (!name.empty() && name.front() == '[') {
    const std::size_t end = name.find(']');
    if (end == std::string_view::npos) return name;
    return end + 1 == name.size() ? name.substr(1, end - 1) : name.substr(end + 1);
  }
  const std::size_t begin = std::min(name.find_first_not_of("\\/"), name.size());
  const std::size_t cut = name.find_first_of("\\/|", begin);
  return cut == std::string_view::npos ? name.substr(begin) : name.substr(cut + 1);
}

}  // namespace

std::string_view without_value_word(std::string_view name) {
  return without_word(without_bracket(name));
}

std::vector<std::string> plain_tags(std::string_view name) {
  std::vector<std::string> forms{std::string(name)};
  if (name.size() > kLongestName) return forms;
  const auto add = [&forms](std::string_view form) {
    if (form.empty() || forms.size() == kMostForms) return;
    if (std::find(forms.begin(), forms.end(), form) == forms.end()) forms.emplace_back(form);
  };
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const std::string form = forms[i];  // `forms` grows
    add(without_bracket(form));
    add(without_word(form));
    add(behind_first_part(form));
  }
  return forms;
}

std::string folded(std::string_view name) {
  std::string text(name);
  make_blanks_plain(text);
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace mpm::files
