#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {

/// Rows of tags with times of their own, as rows `step_s` apart: each tag has the value, good or
/// bad, of its last row up to then, or moves on the line to its next one (`RowSource::next_of`). No
/// row of a tag that is held is used before its time. Where no tag had a row for
/// an hour and 100 steps of the unit nothing is known, and no row is given.
class HeldRows : public RowSource {
 public:
  HeldRows(std::unique_ptr<RowSource> rows, const SignalCounts& counts, double step_s,
           double sample_time_s);

  [[nodiscard]] bool next(Frame& frame) override;
  /// What is made of the times in between.
  [[nodiscard]] std::string notice() const;

 private:
  /// From a tag's last row to its next one.
  struct Line {
    Slot slot;
    std::int64_t from_ns = 0;
    double from = 0.0;
    RowSource::Next to;
  };

  void read();
  void take();
  [[nodiscard]] std::int64_t time_ns() const;

  std::unique_ptr<RowSource> rows_;
  double step_ns_, silence_ns_;
  Frame held_, coming_;
  bool there_ = false;  ///< `coming_`
  std::vector<Line> lines_;
  std::int64_t begin_ns_ = 0, last_ns_ = 0;
  std::int64_t at_ = 0;
};

}  // namespace mpm::files
