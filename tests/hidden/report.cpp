#include "tests/hidden/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/identify/causes/catalog.hpp"
#include "tests/study/interval.hpp"

namespace mpm::hidden {
namespace {

using Row = std::vector<std::string>;
using Scores = std::vector<const CaseScore*>;

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

/// The first row is the head; numbers stand to the right.
std::string render(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string space(widths[i] - rows[r][i].size(), ' ');
      text += "| " + (i == 0 ? rows[r][i] + space : space + rows[r][i]) + ' ';
    }
    text += "|\n";
    if (r > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += i == 0 ? "|" + std::string(widths[i] + 2, '-')
                     : "|" + std::string(widths[i] + 1, '-') + ":";
    text += "|\n";
  }
  return text;
}

/// In the order of the classes; empty ones left out.
std::vector<std::pair<EffectClass, Scores>> by_class(const std::vector<CaseScore>& scores) {
  std::vector<std::pair<EffectClass, Scores>> result;
  for (const EffectClass effect_class : kAllClasses) {
    Scores members;
    for (const CaseScore& score : scores)
      if (score.request.effect_class == effect_class) members.push_back(&score);
    if (!members.empty()) result.emplace_back(effect_class, members);
  }
  return result;
}

/// "18 of 20", or "-" of none.
std::string share(long hits, long total) {
  return total == 0 ? "-" : std::to_string(hits) + " of " + std::to_string(total);
}

std::string percent_with_interval(long hits, long total) {
  const study::Interval interval =
      study::wilson(static_cast<double>(hits), static_cast<double>(total));
  return number(100.0 * static_cast<double>(hits) / static_cast<double>(total), 0) + " [" +
         number(100.0 * interval.low, 0) + ", " + number(100.0 * interval.high, 0) + "]";
}

std::string share_of(const Scores& scores, std::optional<bool> CaseScore::*what) {
  long hits = 0;
  long total = 0;
  for (const CaseScore* score : scores) {
    if (!(score->*what)) continue;
    ++total;
    hits += *(score->*what) ? 1 : 0;
  }
  return share(hits, total);
}

std::vector<double> finite(const Scores& scores, double CaseScore::*what) {
  std::vector<double> values;
  for (const CaseScore* score : scores)
    if (std::isfinite(score->*what)) values.push_back(score->*what);
  return values;
}

std::string median_and_worst_tenth(const std::vector<double>& values, int digits) {
  if (values.empty()) return "-";
  return number(study::quantile(values, 0.5), digits) + " / " +
         number(study::quantile(values, 0.9), digits);
}

Row class_row(const std::string& name, const Scores& scores) {
  long right = 0;
  long onsets = 0;
  int extra = 0;
  double seconds = 0.0;
  std::vector<double> onset_errors;
  for (const CaseScore* score : scores) {
    right += score->cause_right ? 1 : 0;
    extra += score->extra;
    seconds += score->seconds;
    onsets += score->has_onset ? 1 : 0;
    if (score->onset_error) onset_errors.push_back(*score->onset_error);
  }
  const auto count = static_cast<long>(scores.size());
  return {name,
          share(right, count),
          percent_with_interval(right, count),
          share_of(scores, &CaseScore::place_right),
          share_of(scores, &CaseScore::kind_right),
          std::to_string(extra),
          share(static_cast<long>(onset_errors.size()), onsets),
          median_and_worst_tenth(onset_errors, 0),
          median_and_worst_tenth(finite(scores, &CaseScore::rmse_before), 2),
          median_and_worst_tenth(finite(scores, &CaseScore::rmse_after), 2),
          number(seconds / static_cast<double>(count), 2)};
}

}  // namespace

std::string confusion_table(const std::vector<CaseScore>& scores) {
  std::vector<std::string> columns = {"none", "undetermined", "unnamed", kFailed};
  for (const Cause* cause : causes::all()) {
    const std::string name = cause->name().text;
    if (!causes::is_unnamed(*cause) && columns.back() != name) columns.push_back(name);
  }
  // Causes that nobody named stay out, or the table would be wider than any page.
  columns.erase(std::remove_if(columns.begin(), columns.end(),
                               [&](const std::string& column) {
                                 return std::none_of(
                                     scores.begin(), scores.end(),
                                     [&](const CaseScore& score) { return score.named == column; });
                               }),
                columns.end());
  std::vector<Row> rows = {{"hidden"}};
  rows[0].insert(rows[0].end(), columns.begin(), columns.end());
  for (const auto& [effect_class, members] : by_class(scores)) {
    Row row = {name_of(effect_class)};
    for (const std::string& column : columns)
      row.push_back(
          std::to_string(std::count_if(members.begin(), members.end(), [&](const CaseScore* score) {
            return score->named == column;
          })));
    rows.push_back(row);
  }
  return render(rows);
}

std::string class_table(const std::vector<CaseScore>& scores) {
  std::vector<Row> rows = {{"hidden", "cause right", "%", "signals right", "kind right",
                            "findings too many", "onset said", "off by, samples",
                            "RMSE before / true", "RMSE after / true", "s a case"}};
  Scores all;
  for (const auto& [effect_class, members] : by_class(scores)) {
    rows.push_back(class_row(name_of(effect_class), members));
    all.insert(all.end(), members.begin(), members.end());
  }
  if (!all.empty()) rows.push_back(class_row("all", all));
  return render(rows);
}

std::string parameter_table(const std::vector<CaseScore>& scores) {
  struct Entry {
    long covered = 0;
    std::vector<double> errors;
  };
  std::map<std::string, Entry> entries;
  for (const CaseScore& score : scores)
    for (const ParameterScore& parameter : score.parameters) {
      Entry& entry = entries[parameter.name];
      entry.covered += parameter.covered ? 1 : 0;
      entry.errors.push_back(100.0 * parameter.error);
    }
  if (entries.empty()) return "";
  std::vector<Row> rows = {
      {"parameter", "in its 95 % interval", "%", "error, % of what was hidden"}};
  for (const auto& [name, entry] : entries) {
    const auto count = static_cast<long>(entry.errors.size());
    rows.push_back({name, share(entry.covered, count), percent_with_interval(entry.covered, count),
                    median_and_worst_tenth(entry.errors, 1)});
  }
  return render(rows);
}

std::string line_of(const CaseScore& score) {
  return std::string(name_of(score.request.effect_class)) + ' ' + score.request.plant + " seed " +
         std::to_string(score.request.seed) + ": " + score.truth + " -> " + score.answer;
}

}  // namespace mpm::hidden
