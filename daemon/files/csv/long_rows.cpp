#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {
namespace {

/// One line of the file.
struct Sample {
  std::int64_t time_ns = 0;
  Slot slot;
  double value = 0.0;
  Quality quality = Quality::kBad;
};

/// A frame being filled, and what of it has come.
struct Row {
  Frame frame;
  std::array<std::vector<bool>, kSignalKindCount> there;

  void begin(const SignalCounts& counts, std::int64_t time_ns) {
    clear(frame, counts);
    frame.source_time_ns = time_ns;
    for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
      there[kind].assign(static_cast<std::size_t>(counts.of(static_cast<SignalKind>(kind))), false);
  }
};

class LongRows : public RowSource {
 public:
  LongRows(LineReader& lines, const CsvFormat& format, TagTable& tags, const SignalCounts& counts,
           std::vector<std::string>& notices)
      : lines_(lines),
        format_(format),
        times_(format.times, format.order),
        columns_(format_.layout),
        tags_(tags),
        counts_(counts),
        notices_(notices) {
    const int header_line = lines_.number();
    const bool sorted = survey();
    const std::string problem = tags.problem();
    if (!problem.empty()) lines_.fail(header_line, 1, problem);
    return_to(lines_, header_line);
    if (!sorted) gather();
  }

  [[nodiscard]] bool next(Frame& frame) override {
    if (gathered_) {
      if (gathered_->empty()) return false;
      frame = std::move(gathered_->begin()->second.frame);
      gathered_->erase(gathered_->begin());
      return true;
    }
    if (!pending_) pending_ = read_sample();
    if (!pending_) return false;
    row_.begin(counts_, pending_->time_ns);
    while (pending_ && pending_->time_ns == row_.frame.source_time_ns) {
      put(*pending_, row_);
      pending_ = read_sample();
    }
    frame = row_.frame;
    return true;
  }

 private:
  /// Notes every tag; true if the time of those that count never goes back.
  bool survey() {
    bool sorted = true;
    std::int64_t last_ns = 0;
    bool first = true;
    const std::size_t told = notices_.size();
    while (next_line()) {
      tags_.see(tag());
      if (tags_.find(tag()) == nullptr || is_remark()) continue;
      const std::int64_t time_ns = read_time(lines_, cells_, columns_.time, times_, tag());
      sorted = sorted && (first || time_ns >= last_ns);
      last_ns = time_ns;
      first = false;
    }
    notices_.resize(told);  // a cut-off line is told when it is read again
    times_.restart();
    tally_ = {};
    return sorted;
  }

  /// A file sorted by tag has its first frame complete only at its end.
  void gather() {
    gathered_.emplace();
    while (const std::optional<Sample> sample = read_sample()) {
      const auto [entry, is_new] = gathered_->try_emplace(sample->time_ns);
      if (is_new) entry->second.begin(counts_, sample->time_ns);
      put(*sample, entry->second);
    }
  }

  [[nodiscard]] std::string_view tag() const { return cells_[columns_.tag].text; }

  bool next_line() {
    do {
      if (!lines_.next()) return false;
      lines_.split(format_.delimiter, cells_);
    } while (is_empty(cells_) && ++tally_.empty_rows > 0);
    return check_width(lines_, cells_, columns_.width, notices_);
  }

  /// Neither a value nor a time: units below the header, counts below the data.
  [[nodiscard]] bool is_remark() const {
    const std::string_view value = cells_[columns_.value].text;
    if (std::isfinite(parse_value(value, format_.decimal_comma()).value_or(NAN))) return false;
    const std::string text = time_text(cells_, columns_.time);
    if (text.find_first_of("0123456789") == std::string::npos) return true;
    std::string problem;
    return value.empty() && !parse_calendar(text) && !LocalTimes(times_).read(text, tag(), problem);
  }

  /// The next line of a tag that the unit names.
  std::optional<Sample> read_sample() {
    while (next_line()) {
      const Slot* slot = tags_.find(tag());
      if (slot == nullptr) continue;
      if (is_remark()) {
        ++tally_.empty_rows;
        continue;
      }
      Sample sample;
      sample.slot = *slot;
      sample.time_ns = read_time(lines_, cells_, columns_.time, times_, tag());
      sample.value = read_value(lines_, format_, cells_[columns_.value], tally_);
      sample.quality = Quality::kGood;
      for (const QualityColumn& column : columns_.qualities)
        sample.quality = std::max(
            sample.quality, read_quality(lines_, format_, column, cells_[column.cell], tally_));
      if (!std::isfinite(sample.value)) sample.quality = Quality::kBad;
      return sample;
    }
    tally_.tell(notices_);
    tally_ = {};
    for (std::string& notice : times_.notices()) notices_.push_back(std::move(notice));
    times_.restart();
    return std::nullopt;
  }

  void put(const Sample& sample, Row& row) {
    std::vector<bool>& there = row.there[static_cast<std::size_t>(sample.slot.kind)];
    const auto at = static_cast<std::size_t>(sample.slot.index);
    if (there[at]) ++tally_.repeated;
    there[at] = true;
    SignalBlock& block = row.frame[sample.slot.kind];
    block.values(sample.slot.index) = sample.value;
    block.quality[static_cast<std::size_t>(sample.slot.index)] = sample.quality;
  }

  LineReader& lines_;
  CsvFormat format_;
  LocalTimes times_;
  Layout columns_;
  TagTable& tags_;
  SignalCounts counts_;
  std::vector<std::string>& notices_;
  std::vector<Cell> cells_;
  std::optional<Sample> pending_;
  Row row_;
  ReadTally tally_;
  std::optional<std::map<std::int64_t, Row>> gathered_;
};

}  // namespace

std::unique_ptr<RowSource> read_long(LineReader& lines, const CsvFormat& format, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  return std::make_unique<LongRows>(lines, format, tags, counts, notices);
}

}  // namespace mpm::files
