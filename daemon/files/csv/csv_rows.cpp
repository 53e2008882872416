#include "daemon/files/csv/csv_rows.hpp"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "daemon/files/csv/cell.hpp"

namespace mpm::files {
namespace {

constexpr std::string_view kQualitySuffix = ".quality";

bool is_quality(std::string_view name) {
  return name.size() > kQualitySuffix.size() &&
         same_word(name.substr(name.size() - kQualitySuffix.size()), kQualitySuffix);
}

std::vector<std::string> wide_tags(const std::vector<Cell>& header) {
  // Of a column `time` and one that may be called so, the former is the time.
  const bool has_time = std::any_of(header.begin(), header.end(),
                                    [](const Cell& cell) { return same_word(cell.text, "time"); });
  std::vector<std::string> tags;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string_view name = header[i].text;
    const bool is_time = has_time ? same_word(name, "time") : i == 0;
    if (!name.empty() && !is_time && !is_quality(name)) tags.emplace_back(name);
  }
  return tags;
}

std::vector<std::string> long_tags(LineReader& lines, const CsvFormat& format,
                                   const std::vector<Cell>& header) {
  const std::size_t column = tag_column(header);
  std::vector<std::string> tags;
  std::unordered_set<std::string> seen;
  std::vector<Cell> cells;
  while (lines.next()) {
    lines.split(format.delimiter, cells);
    if (column < cells.size() && seen.emplace(cells[column].text).second)
      tags.emplace_back(cells[column].text);
  }
  return tags;
}

}  // namespace

CsvRows::CsvRows(const std::string& path, std::shared_ptr<const TimeZone> zone)
    : lines_(open_file(path), path) {
  if (!lines_.next()) lines_.fail(1, 1, "the file is empty");
  format_ = {find_delimiter(lines_.text()), std::move(zone)};
  std::vector<Cell> header;
  lines_.split(format_.delimiter, header);
  is_long_ = is_long_header(header);
  const std::vector<std::string> tags =
      is_long_ ? long_tags(lines_, format_, header) : wide_tags(header);
  config::UnitConfig unit;
  for (const std::string& tag : tags) {
    columns_.push_back({tag, SignalKind::kAux, static_cast<int>(unit.aux.size())});
    unit.aux.push_back({tag, "", ""});
  }
  lines_.rewind();
  if (!lines_.next()) lines_.fail(1, "the file changed while it was read");
  lines_.split(format_.delimiter, header);
  tags_ = std::make_unique<TagTable>(unit);
  const SignalCounts counts = unit.counts();
  rows_ = is_long_ ? read_long(lines_, format_, header, *tags_, counts, notices_)
                   : read_wide(lines_, format_, header, *tags_, counts, notices_);
}

bool CsvRows::next(Frame& frame) {
  if (rows_->next(frame)) return true;
  if (std::optional<std::string> notice = lines_.take_notice())
    notices_.push_back(std::move(*notice));
  return false;
}

}  // namespace mpm::files
