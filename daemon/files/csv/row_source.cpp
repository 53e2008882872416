#include "daemon/files/csv/row_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"

namespace mpm::files {

namespace {

constexpr std::size_t kNamed = 5;  // words that a notice names

/// `Manual (12), Over Range (3)`, the most frequent first.
std::string listed(const std::map<std::string, std::uint64_t, std::less<>>& counts) {
  std::vector<std::pair<std::uint64_t, std::string>> words;
  words.reserve(counts.size());
  for (const auto& [word, count] : counts) words.emplace_back(count, word);
  std::stable_sort(words.begin(), words.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < words.size() && i < kNamed; ++i)
    text += (i > 0 ? ", " : "") + printable(words[i].second) + " (" +
            std::to_string(words[i].first) + ")";
  return words.size() > kNamed ? text + " ..." : text;
}

std::uint64_t sum(const std::map<std::string, std::uint64_t, std::less<>>& counts) {
  std::uint64_t total = 0;
  for (const auto& [word, count] : counts) total += count;
  return total;
}

void count(std::string_view word, std::map<std::string, std::uint64_t, std::less<>>& counts) {
  static constexpr std::size_t kMostWords = 1000;  // of a file that is not what it seems
  const auto found = counts.find(word);
  if (found != counts.end())
    ++found->second;
  else if (counts.size() < kMostWords)
    counts.emplace(word, 1);
  else
    ++counts[std::string()];
}

// (4000 rows), (4000 rows affected), 1 row
bool is_row_count(std::string_view text) {
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view rest = text.substr(digits);
  return digits > 0 && (rest == " row" || rest == " rows" || rest.starts_with(" row affected") ||
                        rest.starts_with(" rows affected") || rest == " rows selected.");
}

/// How what is no number ought to be exported.
const char* advice_on(std::string_view text) {
  if (text.find(',') != std::string_view::npos)
    return "export it with a decimal point and without thousands separators";
  const std::size_t behind = text.find_first_not_of("+-.0123456789");
  const std::string_view rest = text.substr(std::min(behind, text.size()));
  const std::size_t word = rest.find_first_not_of(' ');
  const bool unit = rest.starts_with('%') || rest.starts_with("\u00B0") || word > 0;
  if (behind == 0 || word == std::string_view::npos || !unit) return "leave empty what is missing";
  const bool digit = rest[word] >= '0' && rest[word] <= '9';
  return digit ? "export it without thousands separators" : "export it without its unit";
}

}  // namespace

void ReadTally::tell(std::vector<std::string>& notices) const {
  if (decimal_commas > 0)
    notices.emplace_back("the comma is read as a decimal point, for it does not part the columns");
  if (decimal_commas > 0 && decimal_points > 0)
    notices.push_back(counted(decimal_points, "number") +
                      " beside those with a point; it is read as a decimal point too, so "
                      "there may be no thousands separators");
  if (!states.empty())
    notices.push_back(counted(sum(states), "value") +
                      " taken as missing, since they are words: " + listed(states));
  if (!qualities.empty())
    notices.push_back(
        std::to_string(sum(qualities)) +
        " qualities taken as bad, since their words are not known: " + listed(qualities));
  if (not_finite > 0)
    notices.push_back(counted(not_finite, "value") +
                      " taken as missing: they are not finite, or too large for a double");
  if (repeated > 0)
    notices.push_back(counted(repeated, "value") +
                      " replaced by later ones of the same tag and time");
  if (empty_rows > 0)
    notices.push_back(counted(empty_rows, "row") + " without time and values left out");
}

std::unique_ptr<RowSource> read_rows(LineReader& lines, const CsvFormat& format,
                                     const std::vector<Cell>& header, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  if (format.layout.is_long) return read_long(lines, format, tags, counts, notices);
  if (!format.layout.pairs.empty()) return read_pairs(lines, format, tags, counts, notices);
  return read_wide(lines, format, header, tags, counts, notices);
}

double read_value(const LineReader& lines, const CsvFormat& format, const Cell& cell,
                  ReadTally& tally) {
  const std::optional<double> value = parse_value(cell.text, format.decimal_comma());
  const bool comma = cell.text.find(',') != std::string_view::npos;
  if (!value && is_state(cell.text)) {
    count(cell.text, tally.states);
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!value) {
    lines.fail(cell.column, "'" + printable(cell.text) + "' is no number; " + advice_on(cell.text));
  }
  if (comma && std::isfinite(*value)) ++tally.decimal_commas;
  if (format.decimal_comma() && cell.text.find('.') != std::string_view::npos)
    ++tally.decimal_points;
  if (format.decimal_comma() && may_be_thousands(cell.text)) tally.may_be_thousands = true;
  if (tally.may_be_thousands && tally.decimal_commas > 0)
    lines.fail(cell.column,
               "'" + printable(cell.text) +
                   "': the file has decimal commas, and a number such as 1.050, which may be 1050 "
                   "or 1.05; export it without thousands separators");
  if (!std::isinf(*value)) return *value;
  ++tally.not_finite;
  return std::numeric_limits<double>::quiet_NaN();
}

std::int64_t read_time(const LineReader& lines, const std::vector<Cell>& cells,
                       const TimeColumns& columns, LocalTimes& times, std::string_view series) {
  std::string problem;
  if (!columns.clock) {
    const Cell& cell = cells[columns.time];
    if (const auto time_ns = times.read(cell.text, series, problem)) return *time_ns;
    lines.fail(cell.column, "'" + printable(cell.text) + "' " + problem);
  }
  const std::string text = time_text(cells, columns);
  if (const auto time_ns = times.read(text, series, problem)) return *time_ns;
  lines.fail(cells[columns.time].column, "'" + printable(text) + "' " + problem);
}

Quality read_quality(const LineReader& lines, const CsvFormat& format, const QualityColumn& column,
                     const Cell& cell, ReadTally& tally) {
  const std::optional<Quality> quality =
      parse_quality(cell.text, column.kind, format.zero_is_good && !column.sure);
  if (quality) return *quality;
  if (column.sure)
    lines.fail(cell.column,
               "'" + printable(cell.text) + "' is no quality: good, uncertain, bad or an OPC code");
  count(cell.text, tally.qualities);
  return Quality::kBad;
}

bool is_empty(const std::vector<Cell>& cells) {
  return std::all_of(cells.begin(), cells.end(),
                     [](const Cell& cell) { return cell.text.empty(); });
}

void clear(Frame& frame, const SignalCounts& counts) {
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind) {
    SignalBlock& block = frame.blocks[kind];
    const int count = counts.of(static_cast<SignalKind>(kind));
    if (block.size() != count) block.resize(count);
    block.values.setConstant(std::numeric_limits<double>::quiet_NaN());
    std::fill(block.quality.begin(), block.quality.end(), Quality::kBad);
  }
}

bool check_width(LineReader& lines, char delimiter, std::vector<Cell>& cells, std::size_t width,
                 std::vector<std::string>& notices) {
  if (cells.size() == 1 && width > 1 && is_row_count(cells.front().text)) {
    notices.push_back("line " + std::to_string(lines.number()) + ", " +
                      std::string(cells.front().text) + ", ends the data");
    while (lines.next()) {  // what such a tool says besides
      lines.split(delimiter, cells);
      if (cells.size() >= width)
        lines.fail(1, "more rows behind their number: give one table a file");
    }
    return false;
  }
  if (cells.size() < width) {
    if (lines.complete())
      lines.fail(cells.back().column,
                 "has " + counted(cells.size(), "cell") + ", the header " + std::to_string(width));
    notices.push_back("line " + std::to_string(lines.number()) + " is cut off and ignored");
    return false;
  }
  for (std::size_t i = width; i < cells.size(); ++i)  // a delimiter at the end does no harm
    if (!cells[i].text.empty())
      lines.fail(cells[i].column,
                 "has " + counted(cells.size(), "cell") + ", the header " + std::to_string(width));
  return true;
}

}  // namespace mpm::files
