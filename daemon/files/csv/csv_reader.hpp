#pragma once

#include <cstdint>
#include <deque>
#include <istream>
#include <memory>
#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/frame_source.hpp"

namespace mpm::files {

/// Data files (interfaces: "Data file"): wide rows `time,<tag>,...` or long ones
/// `tag,time,value,quality`, in the layouts of docs/data.md. Memory stays flat, except for a long
/// file that is not sorted by time and for columns of times and values in turn.
///
/// Where each tag has times of its own, its values are held from one to the next or lie on the line
/// to it (`HeldRows`); minutes without seconds are spread (`SpreadRows`); to judge a unit, rows at
/// least twice as dense as its sample_time are averaged down to it (`AveragedRows`). Each is noted.
/// Calculated signals are computed in each row (`PreparedRows`).
///
/// Frame k of a file is numbered round((t - t_first) / sample_time); rows whose time does not grow
/// keep their number, for the monitor to judge.
class CsvReader : public FrameSource {
 public:
  /// Reads the header and the first rows. Throws config::InputError (`file:line:col: message`) if
  /// the file cannot be opened, a tag that the purpose needs is missing or the rows are
  /// neither sample_time apart nor dense enough to be averaged.
  /// Local times without a zone in `times` are refused.
  CsvReader(const std::string& path, const config::UnitConfig& unit, const TimeStyle& times = {},
            Purpose purpose = Purpose::kJudge);
  /// The same from a stream that can seek; `name` stands for the file in messages.
  CsvReader(std::unique_ptr<std::istream> input, const std::string& name,
            const config::UnitConfig& unit, const TimeStyle& times = {},
            Purpose purpose = Purpose::kJudge);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] double share_read() const override;
  [[nodiscard]] const std::vector<std::string>& notices() const override { return notices_; }
  /// True if the file has the tag.
  [[nodiscard]] bool holds(const std::string& tag) const { return tags_.seen(tag); }

 private:
  void open(const config::UnitConfig& unit, const TimeStyle& times);
  void hold(const SignalCounts& counts);
  void look_ahead();
  void spread_minutes(int header_line);
  void fit_sample_time(int first_line);
  void average(double step_s);
  [[nodiscard]] bool read(Frame& frame);
  void number(Frame& frame);
  /// Intervals since the first row, by the clock of the file as followed so far.
  [[nodiscard]] double elapsed(const Frame& frame) const;
  [[nodiscard]] bool clock_stays_back(double at);

  double sample_time_s_;
  Purpose purpose_;
  std::uintmax_t file_bytes_ = 0;  // 0 = not known
  LineReader lines_;
  TagTable tags_;
  std::vector<std::string> row_notices_;
  std::vector<std::string> notices_;
  std::unique_ptr<RowSource> rows_;
  std::deque<Frame> ahead_;  ///< rows read to learn what follows
  std::int64_t first_ns_ = 0;
  std::int64_t last_ = -1;  ///< largest interval so far
  double phase_ = 0.0;      ///< of the file's clock against the numbering, intervals
};

}  // namespace mpm::files
