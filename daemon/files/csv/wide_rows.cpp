#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "config/suggest.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {
namespace {

constexpr int kRowsBelow = 3;  // that may stand between a header and its first row

/// What a column of the file fills.
struct Column {
  std::size_t cell = 0;
  Slot slot;
};

class WideRows : public RowSource {
 public:
  WideRows(LineReader& lines, const CsvFormat& format, const std::vector<Cell>& header,
           TagTable& tags, const SignalCounts& counts, std::vector<std::string>& notices)
      : lines_(lines),
        format_(format),
        times_(format.times, format.order),
        counts_(counts),
        notices_(notices) {
    find_columns(header, tags);
    const std::string problem = tags.problem();
    if (!problem.empty()) lines_.fail(1, problem);
  }

  [[nodiscard]] bool next(Frame& frame) override {
    do {
      if (!lines_.next()) return end();
      lines_.split(format_.delimiter, cells_);
    } while (is_no_data());
    begun_ = true;
    if (!check_width(lines_, format_.delimiter, cells_, format_.layout.width, notices_))
      return end();
    clear(frame, counts_);
    frame.source_time_ns = read_time(lines_, cells_, format_.layout.time, times_);
    for (const Column& column : values_) {
      const double value = read_value(lines_, format_, cells_[column.cell], tally_);
      SignalBlock& block = frame[column.slot.kind];
      block.values(column.slot.index) = value;
      if (std::isfinite(value))
        block.quality[static_cast<std::size_t>(column.slot.index)] = Quality::kGood;
    }
    for (const auto& [column, slot] : qualities_) {
      const Quality quality = read_quality(lines_, format_, column, cells_[column.cell], tally_);
      Quality& target = frame[slot.kind].quality[static_cast<std::size_t>(slot.index)];
      target = std::max(target, quality);  // a missing value stays bad
    }
    return true;
  }

 private:
  bool end() {
    tally_.tell(notices_);
    tally_ = {};
    for (std::string& notice : times_.notices()) notices_.push_back(std::move(notice));
    times_.restart();
    return false;
  }

  void find_columns(const std::vector<Cell>& header, TagTable& tags) {
    const Layout& layout = format_.layout;
    for (const std::size_t cell : layout.values) tags.see(header[cell].text);
    std::map<std::string_view, int> first_columns;
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string_view name = header[i].text;
      if (name.empty()) continue;
      const auto [first, is_new] = first_columns.emplace(name, header[i].column);
      if (!is_new && (tags.find(name) != nullptr || name == header[layout.time.time].text))
        lines_.fail(header[i].column, "a second column '" + std::string(name) +
                                          "'; the first is at column " +
                                          std::to_string(first->second));
    }
    for (const std::size_t cell : layout.values)
      if (const Slot* slot = tags.find(header[cell].text)) values_.push_back({cell, *slot});
    for (const QualityColumn& column : layout.qualities)
      if (const Slot* slot = tags.find(header[column.value].text))
        qualities_.emplace_back(column, *slot);
    if (!layout.orphans.empty())
      notices_.push_back("ignored, since the tag that they qualify has no column: " +
                         config::join(layout.orphans));
    if (layout.without_name > 0)
      notices_.push_back(std::to_string(layout.without_name) +
                         " columns without a name are ignored");
  }

  /// Rows of nothing, as spreadsheets leave them behind; before the first time units and
  /// descriptions, as historians export them.
  bool is_no_data() {
    if (is_empty(cells_)) {
      ++tally_.empty_rows;
      return true;
    }
    const std::size_t time = format_.layout.time.time;
    if (begun_ || above_ == kRowsBelow || time >= cells_.size()) return false;
    if (cells_[time].text.find_first_of("0123456789") != std::string_view::npos) return false;
    for (const Column& column : values_) {
      if (column.cell >= cells_.size()) continue;
      const std::optional<double> value =
          parse_value(cells_[column.cell].text, format_.decimal_comma());
      if (value && std::isfinite(*value)) return false;  // data without a time
    }
    ++above_;
    notices_.push_back("line " + std::to_string(lines_.number()) +
                       " is taken for a row of units and left out");
    return true;
  }

  LineReader& lines_;
  CsvFormat format_;
  LocalTimes times_;
  SignalCounts counts_;
  std::vector<std::string>& notices_;
  std::vector<Column> values_;
  std::vector<std::pair<QualityColumn, Slot>> qualities_;
  std::vector<Cell> cells_;
  ReadTally tally_;
  bool begun_ = false;
  int above_ = 0;  ///< rows of units
};

}  // namespace

std::unique_ptr<RowSource> read_wide(LineReader& lines, const CsvFormat& format,
                                     const std::vector<Cell>& header, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  return std::make_unique<WideRows>(lines, format, header, tags, counts, notices);
}

}  // namespace mpm::files
