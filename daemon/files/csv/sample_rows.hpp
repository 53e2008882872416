#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {

inline constexpr std::size_t kNoSample = std::numeric_limits<std::size_t>::max();

/// One value of one tag.
struct Sample {
  std::int64_t time_ns = 0;
  double value = 0.0;
  Slot slot;
  Quality quality = Quality::kBad;
  std::size_t next = kNoSample;  ///< of the same tag, once all are gathered
};

/// Whether the tags of a file are sampled together, or each has times of its own.
class TagTimes {
 public:
  /// Samples of different tags count as of one time up to so much later than the first of them.
  explicit TagTimes(const SignalCounts& counts, std::int64_t within_ns = 0);

  /// Times never go back.
  void add(const Slot& slot, std::int64_t time_ns);
  /// True if some tag has samples at too few of all times since its first one to be sampled
  /// together with the others.
  [[nodiscard]] bool apart() const;
  /// All times, those of several tags counted once.
  [[nodiscard]] std::int64_t count() const { return count_; }

 private:
  struct Tag {
    std::int64_t first = 0, last = 0, count = 0;  // in numbers of times, from 1
  };
  std::array<std::vector<Tag>, kSignalKindCount> tags_;
  std::int64_t within_ns_;
  std::int64_t count_ = 0;
  std::int64_t begin_ns_ = 0;  // of the last one
};

/// Frames of samples that come one by one: those of one time make a row. Where each tag has times
/// of its own, but they nearly go together, those of nearly one time do (`CsvFormat::together_ns`).
class SampleRows : public RowSource {
 public:
  SampleRows(LineReader& lines, const CsvFormat& format, const SignalCounts& counts,
             std::vector<std::string>& notices)
      : lines_(lines),
        format_(format),
        times_(format.times, format.order),
        notices_(notices),
        counts_(counts),
        tag_times_(counts),
        near_times_(counts, format.together_ns) {}

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] const Told* told() const override { return &told_; }

 protected:
  /// The next one of the file.
  [[nodiscard]] virtual std::optional<Sample> read_sample() = 0;
  /// The one of `tag` in the line at hand; the worst of `qualities` counts.
  [[nodiscard]] Sample sample_of(std::string_view tag, const Slot& slot, const TimeColumns& time,
                                 const Cell& value, const std::vector<QualityColumn>& qualities);
  /// Reads all there are, for a file that has them in another order than that of time: 40 bytes
  /// for each.
  void gather();
  /// What comes after the last row's sample of a tag; null where nothing does or is gathered.
  [[nodiscard]] const Sample* following(SignalKind kind, std::size_t index) const;

  /// Of a sample, for who comes to know them without gathering them.
  void note_time(const Slot& slot, std::int64_t time_ns);
  [[nodiscard]] std::int64_t times() const { return tag_times_.count(); }
  /// Whether the tags are not sampled together, not even nearly; once gathered, or all noted.
  [[nodiscard]] bool apart() const { return tag_times_.apart() && near_times_.apart(); }

  LineReader& lines_;
  CsvFormat format_;
  LocalTimes times_;
  std::vector<std::string>& notices_;
  std::vector<Cell> cells_;  ///< of the line at hand
  ReadTally tally_;

 private:
  std::optional<Sample> next_sample();
  void tell();
  void put(const Sample& sample, Frame& frame);
  [[nodiscard]] bool told(const Slot& slot) const;

  SignalCounts counts_;
  TagTimes tag_times_, near_times_;
  std::optional<std::vector<Sample>> gathered_;
  std::size_t at_ = 0;  ///< in `gathered_`
  std::optional<Sample> pending_;
  Told told_;
  std::array<std::vector<std::size_t>, kSignalKindCount> next_;  ///< of those of the last row
};

}  // namespace mpm::files
