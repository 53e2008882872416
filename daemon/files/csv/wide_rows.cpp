#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "config/suggest.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {
namespace {

constexpr std::string_view kQualitySuffix = ".quality";

/// What a column of the file fills.
struct Column {
  std::size_t cell = 0;
  Slot slot;
};

bool is_units_word(std::string_view text) {
  static constexpr std::array<std::string_view, 7> kWords = {"",    "unit", "units",  "s",
                                                             "[s]", "sec",  "seconds"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [text](std::string_view word) { return same_word(text, word); });
}

class WideRows : public RowSource {
 public:
  WideRows(LineReader& lines, const CsvFormat& format, const std::vector<Cell>& header,
           TagTable& tags, const SignalCounts& counts, std::vector<std::string>& notices)
      : lines_(lines),
        format_(format),
        times_(format.zone),
        width_(header.size()),
        counts_(counts),
        notices_(notices) {
    find_time(header);
    find_columns(header, tags);
    const std::string problem = tags.problem();
    if (!problem.empty()) lines_.fail(1, problem);
  }

  [[nodiscard]] bool next(Frame& frame) override {
    do {
      if (!lines_.next()) return end();
      lines_.split(format_.delimiter, cells_);
    } while (is_units_row());
    if (!check_width(lines_, cells_, width_, notices_)) return end();
    clear(frame, counts_);
    frame.source_time_ns = read_time(lines_, cells_[time_], times_);
    for (const Column& column : values_) {
      const double value = read_value(lines_, format_, cells_[column.cell], tally_);
      SignalBlock& block = frame[column.slot.kind];
      block.values(column.slot.index) = value;
      if (std::isfinite(value))
        block.quality[static_cast<std::size_t>(column.slot.index)] = Quality::kGood;
    }
    for (const Column& column : qualities_) {
      const Quality quality = read_quality(lines_, cells_[column.cell]);
      Quality& target =
          frame[column.slot.kind].quality[static_cast<std::size_t>(column.slot.index)];
      target = std::max(target, quality);  // a missing value stays bad
    }
    return true;
  }

 private:
  bool end() {
    tally_.tell(notices_);
    tally_ = {};
    if (const std::string notice = times_.notice(); !notice.empty()) notices_.push_back(notice);
    times_.restart();
    return false;
  }

  void find_time(const std::vector<Cell>& header) {
    const auto found = std::find_if(header.begin(), header.end(),
                                    [](const Cell& cell) { return same_word(cell.text, "time"); });
    if (found != header.end()) {
      time_ = static_cast<std::size_t>(found - header.begin());
    } else if (!is_time_name(header.front().text)) {
      lines_.fail(header.front().column, "the first column must be `time`, not '" +
                                             std::string(header.front().text) + "'");
    }
  }

  void find_columns(const std::vector<Cell>& header, TagTable& tags) {
    std::map<std::string_view, int> first_columns;
    std::vector<std::string> without_tag;
    std::size_t without_name = 0;
    for (std::size_t i = 0; i < header.size(); ++i) {
      const std::string_view name = header[i].text;
      if (name.empty() && i + 1 == header.size()) {  // a delimiter at the end
        --width_;
        break;
      }
      if (name.empty()) {
        ++without_name;
        continue;
      }
      const auto [first, is_new] = first_columns.emplace(name, header[i].column);
      if (!is_new && (tags.find(name) != nullptr || i == time_))
        lines_.fail(header[i].column, "a second column '" + std::string(name) +
                                          "'; the first is at column " +
                                          std::to_string(first->second));
      if (i == time_ || !is_new) continue;
      const std::size_t suffix = name.size() - std::min(name.size(), kQualitySuffix.size());
      if (suffix > 0 && same_word(name.substr(suffix), kQualitySuffix)) {
        const std::string_view tag = name.substr(0, suffix);
        const Slot* slot = tags.find(tag);
        if (!holds(header, tag))
          without_tag.emplace_back(name);
        else if (slot != nullptr)
          qualities_.push_back({i, *slot});
        continue;
      }
      tags.see(name);
      if (const Slot* slot = tags.find(name)) values_.push_back({i, *slot});
    }
    if (!without_tag.empty())
      notices_.push_back("ignored, since the tag that they qualify has no column: " +
                         config::join(without_tag));
    if (without_name > 0)
      notices_.push_back(std::to_string(without_name) + " columns without a name are ignored");
  }

  static bool holds(const std::vector<Cell>& header, std::string_view name) {
    return std::any_of(header.begin(), header.end(),
                       [name](const Cell& cell) { return cell.text == name; });
  }

  /// Engineering units below the header, as historians export them.
  bool is_units_row() {
    if (seen_first_) return false;
    seen_first_ = true;
    if (time_ >= cells_.size() || !is_units_word(cells_[time_].text)) return false;
    for (const Column& column : values_) {
      if (column.cell >= cells_.size()) continue;
      const std::optional<double> value =
          parse_value(cells_[column.cell].text, format_.decimal_comma());
      if (value && std::isfinite(*value)) return false;  // data without a time
    }
    notices_.push_back("line " + std::to_string(lines_.number()) +
                       " is taken for a row of units and left out");
    return true;
  }

  LineReader& lines_;
  CsvFormat format_;
  LocalTimes times_;
  std::size_t width_;
  SignalCounts counts_;
  std::vector<std::string>& notices_;
  std::size_t time_ = 0;
  std::vector<Column> values_, qualities_;
  std::vector<Cell> cells_;
  ReadTally tally_;
  bool seen_first_ = false;
};

}  // namespace

std::unique_ptr<RowSource> read_wide(LineReader& lines, const CsvFormat& format,
                                     const std::vector<Cell>& header, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  return std::make_unique<WideRows>(lines, format, header, tags, counts, notices);
}

}  // namespace mpm::files
