#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {
namespace {

struct LongColumns {
  std::optional<std::size_t> tag, time, value, quality;

  [[nodiscard]] bool complete() const { return tag && time && value; }
};

template <std::size_t n>
std::optional<std::size_t> find_column(const std::vector<Cell>& header,
                                       const std::array<std::string_view, n>& names) {
  for (const std::string_view name : names)
    for (std::size_t i = 0; i < header.size(); ++i)
      if (same_word(header[i].text, name)) return i;
  return std::nullopt;
}

LongColumns find_columns(const std::vector<Cell>& header) {
  LongColumns columns;
  columns.tag = find_column(
      header, std::array<std::string_view, 4>{"tag", "tagname", "tag_name", "tag name"});
  columns.value = find_column(header, std::array<std::string_view, 2>{"value", "val"});
  // AVEVA's Quality is a code of its own beside OPCQuality.
  columns.quality =
      find_column(header, std::array<std::string_view, 3>{"opcquality", "quality", "status"});
  for (std::size_t i = 0; i < header.size() && !columns.time; ++i)
    if (is_time_name(header[i].text)) columns.time = i;
  return columns;
}

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
  LongRows(LineReader& lines, const CsvFormat& format, const std::vector<Cell>& header,
           TagTable& tags, const SignalCounts& counts, std::vector<std::string>& notices)
      : lines_(lines),
        format_(format),
        times_(format.zone),
        columns_(find_columns(header)),
        width_(header.back().text.empty() ? header.size() - 1 : header.size()),
        tags_(tags),
        counts_(counts),
        notices_(notices) {
    const int header_line = lines_.number();
    const bool sorted = survey();
    const std::string problem = tags.problem();
    if (!problem.empty()) lines_.fail(header_line, 1, problem);
    lines_.rewind();
    if (!lines_.next()) lines_.fail(1, "the file changed while it was read");
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
  /// Notes every tag; true if time never goes back.
  bool survey() {
    bool sorted = true;
    std::int64_t last_ns = 0;
    bool first = true;
    while (next_line()) {
      tags_.see(cells_[*columns_.tag].text);
      const std::int64_t time_ns =
          read_time(lines_, cells_[*columns_.time], times_, cells_[*columns_.tag].text);
      sorted = sorted && (first || time_ns >= last_ns);
      last_ns = time_ns;
      first = false;
    }
    notices_.clear();  // a cut-off line is told when it is read again
    times_.restart();
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

  bool next_line() {
    if (!lines_.next()) return false;
    lines_.split(format_.delimiter, cells_);
    return check_width(lines_, cells_, width_, notices_);
  }

  /// The next line of a tag that the unit names.
  std::optional<Sample> read_sample() {
    while (next_line()) {
      const Slot* slot = tags_.find(cells_[*columns_.tag].text);
      if (slot == nullptr) continue;
      Sample sample;
      sample.slot = *slot;
      sample.time_ns =
          read_time(lines_, cells_[*columns_.time], times_, cells_[*columns_.tag].text);
      sample.value = read_value(lines_, format_, cells_[*columns_.value], tally_);
      sample.quality = Quality::kGood;
      if (columns_.quality) sample.quality = read_quality(lines_, cells_[*columns_.quality]);
      if (!std::isfinite(sample.value)) sample.quality = Quality::kBad;
      return sample;
    }
    tally_.tell(notices_);
    tally_ = {};
    if (const std::string notice = times_.notice(); !notice.empty()) notices_.push_back(notice);
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
  LongColumns columns_;
  std::size_t width_;
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

bool is_long_header(const std::vector<Cell>& header) { return find_columns(header).complete(); }

std::size_t tag_column(const std::vector<Cell>& header) {
  return find_columns(header).tag.value_or(0);
}

std::unique_ptr<RowSource> read_long(LineReader& lines, const CsvFormat& format,
                                     const std::vector<Cell>& header, TagTable& tags,
                                     const SignalCounts& counts,
                                     std::vector<std::string>& notices) {
  return std::make_unique<LongRows>(lines, format, header, tags, counts, notices);
}

}  // namespace mpm::files
