#include "daemon/files/csv/csv_rows.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "daemon/files/csv/prepared_rows.hpp"

namespace mpm::files {
namespace {

std::vector<std::string> wide_tags(const Layout& layout, const std::vector<Cell>& header) {
  std::vector<std::string> tags;
  for (const PairedColumns& pair : layout.pairs)
    if (!pair.name.empty()) tags.push_back(pair.name);
  for (const std::size_t cell : layout.values) tags.emplace_back(header[cell].text);
  return tags;
}

std::vector<std::string> long_tags(LineReader& lines, const CsvFormat& format) {
  const std::size_t column = format.layout.tag;
  std::vector<std::string> tags;
  std::unordered_set<std::string> seen;
  std::vector<Cell> cells;
  while (lines.next()) {
    lines.split(format.delimiter, cells);
    if (column < cells.size() && !cells[column].text.empty() &&
        seen.emplace(cells[column].text).second)
      tags.emplace_back(cells[column].text);
  }
  return tags;
}

}  // namespace

CsvRows::CsvRows(const std::string& path, const TimeStyle& times, const config::UnitConfig* known)
    : lines_(open_regular_file(path), path) {
  lines_.join_quoted();
  std::vector<Cell> header;
  format_ = find_format(lines_, times, 0.0, nullptr, header, notices_);
  const int header_line = lines_.number();
  std::vector<std::string> tags =
      format_.layout.is_long ? long_tags(lines_, format_) : wide_tags(format_.layout, header);
  if (known != nullptr) call_as(*known, header_line, tags);
  config::UnitConfig unit;
  for (const std::string& tag : tags) {
    columns_.push_back({tag, SignalKind::kAux, static_cast<int>(unit.aux.size())});
    unit.aux.push_back({tag, "", ""});
  }
  for (const config::CalculatedSignal& signal :
       known != nullptr ? known->calc : std::vector<config::CalculatedSignal>()) {
    const auto has = [&unit](const std::string& tag) {
      return unit.calculation_of(tag) != nullptr ||
             std::any_of(unit.aux.begin(), unit.aux.end(),
                         [&](const config::InputSignal& aux) { return aux.tag == tag; });
    };
    if (!std::all_of(signal.inputs.begin(), signal.inputs.end(), has)) continue;
    if (!has(signal.tag)) {
      columns_.push_back({signal.tag, SignalKind::kAux, static_cast<int>(unit.aux.size())});
      unit.aux.push_back({signal.tag, "", ""});
    }
    unit.calc.push_back(signal);
  }
  return_to(lines_, header_line);
  lines_.split(format_.delimiter, header);
  tags_ = std::make_unique<TagTable>(unit);
  const SignalCounts counts = unit.counts();
  rows_ = read_rows(lines_, format_, header, *tags_, counts, notices_);
  if (!unit.calc.empty())
    rows_ = std::make_unique<PreparedRows>(std::move(rows_), unit, Purpose::kKeep);
}

void CsvRows::call_as(const config::UnitConfig& known, int header_line,
                      std::vector<std::string>& tags) {
  TagTable names(known, Purpose::kKeep);
  for (const std::string& tag : tags) names.see(tag);
  if (const std::string problem = names.problem(); !problem.empty())
    lines_.fail(header_line, 1, problem);
  if (std::string readings = names.readings(); !readings.empty())
    notices_.push_back(std::move(readings));
  for (std::string& tag : tags)
    if (const std::string* called = names.tag_of(tag)) tag = *called;
}

const char* CsvRows::layout() const {
  if (format_.layout.is_long) return "long";
  return format_.layout.pairs.empty() ? "wide" : "pairs";
}

bool CsvRows::next(Frame& frame) {
  if (rows_->next(frame)) return true;
  if (std::optional<std::string> notice = lines_.take_notice())
    notices_.push_back(std::move(*notice));
  return false;
}

}  // namespace mpm::files
