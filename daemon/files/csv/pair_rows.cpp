#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/csv/sample_rows.hpp"

namespace mpm::files {
namespace {

constexpr int kRowsBelow = 3;  // that may stand between a header and its first row

/// What the unit names of a file's columns of times and values in turn. A row has the first samples
/// of all tags, the next one their second ones, and so on: their times have nothing to do with each
/// other, so all are read first.
class PairRows : public SampleRows {
 public:
  PairRows(LineReader& lines, const CsvFormat& format, TagTable& tags, const SignalCounts& counts,
           std::vector<std::string>& notices)
      : SampleRows(lines, format, counts, notices) {
    find_columns(tags);
    gather();
  }

  [[nodiscard]] bool has_own_times() const override { return apart(); }

  [[nodiscard]] bool has_lines() const override { return true; }
  [[nodiscard]] std::optional<Next> next_of(SignalKind kind, std::size_t index) const override {
    // What somebody sets stays until it is set again.
    if (kind == SignalKind::kMv || kind == SignalKind::kSetpoint) return std::nullopt;
    const Sample* next = following(kind, index);
    if (next == nullptr || next->quality == Quality::kBad) return std::nullopt;
    return Next{next->time_ns, next->value};
  }

 private:
  struct Pair {
    PairedColumns columns;
    Slot slot;
    std::vector<QualityColumn> qualities;
  };

  void find_columns(TagTable& tags) {
    int nameless = 0;
    for (const PairedColumns& pair : format_.layout.pairs) {
      if (pair.name.empty())
        ++nameless;
      else
        tags.see(pair.name);
    }
    const std::string problem = tags.problem();
    if (!problem.empty()) lines_.fail(1, problem);
    for (const PairedColumns& columns : format_.layout.pairs) {
      const Slot* slot = columns.name.empty() ? nullptr : tags.find(columns.name);
      if (slot == nullptr) continue;
      for (const Pair& other : pairs_)
        if (other.slot.kind == slot->kind && other.slot.index == slot->index)
          lines_.fail(1, "'" + columns.name + "' stands above two pairs of columns");
      Pair pair{columns, *slot, {}};
      for (const QualityColumn& quality : format_.layout.qualities)
        if (quality.value == columns.value) pair.qualities.push_back(quality);
      pairs_.push_back(std::move(pair));
    }
    if (nameless > 0)
      notices_.push_back(std::to_string(nameless) + " pairs of columns without a name are ignored");
  }

  std::optional<Sample> read_sample() override {
    while (true) {
      for (; at_ < pairs_.size(); ++at_)
        if (std::optional<Sample> sample = read_pair(pairs_[at_])) {
          ++at_;
          return sample;
        }
      if (!next_row()) return std::nullopt;
      at_ = 0;
    }
  }

  bool next_row() {
    do {
      if (!lines_.next()) return false;
      lines_.split(format_.delimiter, cells_);
    } while (is_no_data());
    return check_width(lines_, format_.delimiter, cells_, format_.layout.width, notices_);
  }

  /// Rows of nothing, and before the first time units, words, how many values follow.
  bool is_no_data() {
    if (is_empty(cells_)) {
      ++tally_.empty_rows;
      return true;
    }
    const auto has_time = [this](const Pair& pair) {
      return pair.columns.time < cells_.size() &&
             cells_[pair.columns.time].text.find_first_of("0123456789") != std::string_view::npos;
    };
    if (begun_ || above_ == kRowsBelow || std::any_of(pairs_.begin(), pairs_.end(), has_time)) {
      begun_ = true;
      return false;
    }
    ++above_;
    notices_.push_back("line " + std::to_string(lines_.number()) +
                       " is taken for a row of units and left out");
    return true;
  }

  /// Nothing where the tag has no more samples.
  std::optional<Sample> read_pair(const Pair& pair) {
    const Cell& value = cells_[pair.columns.value];
    if (cells_[pair.columns.time].text.empty() && value.text.empty()) return std::nullopt;
    return sample_of(pair.columns.name, pair.slot, {pair.columns.time, std::nullopt}, value,
                     pair.qualities);
  }

  std::vector<Pair> pairs_;
  std::size_t at_ = kNoSample;  ///< the pair to read next in the row at hand
  bool begun_ = false;
  int above_ = 0;  ///< rows of units
};

}  // namespace

std::unique_ptr<RowSource> read_pairs(LineReader& lines, const CsvFormat& format, TagTable& tags,
                                      const SignalCounts& counts,
                                      std::vector<std::string>& notices) {
  return std::make_unique<PairRows>(lines, format, tags, counts, notices);
}

}  // namespace mpm::files
