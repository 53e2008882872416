#include "daemon/files/csv/row_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/text/printable.hpp"
#include "daemon/files/csv/cell.hpp"

namespace mpm::files {

void ReadTally::tell(std::vector<std::string>& notices) const {
  if (not_finite > 0)
    notices.push_back(std::to_string(not_finite) +
                      " values taken as missing: they are not finite, or too large for a double");
  if (repeated > 0)
    notices.push_back(std::to_string(repeated) +
                      " values replaced by later ones of the same tag and time");
}

double read_value(const LineReader& lines, const CsvFormat& format, const Cell& cell,
                  ReadTally& tally) {
  const std::optional<double> value = parse_value(cell.text, format.decimal_comma());
  if (!value)
    lines.fail(cell.column,
               "'" + printable(cell.text) + "' is no number; leave empty what is missing");
  if (!std::isinf(*value)) return *value;
  ++tally.not_finite;
  return std::numeric_limits<double>::quiet_NaN();
}

std::int64_t read_time(const LineReader& lines, const Cell& cell, LocalTimes& times,
                       std::string_view series) {
  std::string problem;
  const std::optional<std::int64_t> time_ns = times.read(cell.text, series, problem);
  if (!time_ns) lines.fail(cell.column, "'" + printable(cell.text) + "' " + problem);
  return *time_ns;
}

Quality read_quality(const LineReader& lines, const Cell& cell) {
  const std::optional<Quality> quality = parse_quality(cell.text);
  if (!quality)
    lines.fail(cell.column,
               "'" + printable(cell.text) + "' is no quality: good, uncertain, bad or an OPC code");
  return *quality;
}

bool is_time_name(std::string_view name) {
  static constexpr std::array<std::string_view, 8> kNames = {
      "time", "timestamp", "time stamp", "datetime", "date_time", "time_s", "t_s", "t"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [name](std::string_view known) { return same_word(name, known); });
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

bool check_width(const LineReader& lines, const std::vector<Cell>& cells, std::size_t width,
                 std::vector<std::string>& notices) {
  if (cells.size() < width) {
    if (lines.complete())
      lines.fail(cells.back().column, "has " + std::to_string(cells.size()) +
                                          " cells, the header " + std::to_string(width));
    notices.push_back("line " + std::to_string(lines.number()) + " is cut off and ignored");
    return false;
  }
  for (std::size_t i = width; i < cells.size(); ++i)  // a delimiter at the end does no harm
    if (!cells[i].text.empty())
      lines.fail(cells[i].column, "has " + std::to_string(cells.size()) + " cells, the header " +
                                      std::to_string(width));
  return true;
}

}  // namespace mpm::files
