#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {

/// Rows that are a fraction of a control interval apart as one for each interval, as a controller
/// of that interval has them. Intervals go on from time t_0: t_k = t_0 + k sample_time. As in every
/// `Frame`, what was measured at t_k comes before what acts from then on:
///   MVs, DVs and aux signals are means over [t_k, t_k+1), in which they act,
///   CVs, predictions and set-points are the last row up to t_k, no older than half an interval.
/// So no CV depends on an input of its own row, and none is late: its mean would be by half an
/// interval, a dead time that the plant does not have. What is good is taken; where nothing is,
/// what is uncertain, and the result is that too. Intervals without a row are left out, and so are
/// rows that go back into the interval before (noted); those that go back further are given as they
/// come.
class AveragedRows : public RowSource {
 public:
  /// `read` are the first rows of `rows`, at least one; `step_s` is the time between two, at most
  /// about half of `sample_time_s`.
  AveragedRows(std::unique_ptr<RowSource> rows, std::deque<Frame> read, std::int64_t begin_ns,
               double step_s, double sample_time_s, std::vector<std::string>& notices);

  [[nodiscard]] bool next(Frame& frame) override;

 private:
  /// What one value is the mean of.
  struct Mean {
    double sum = 0.0;
    int count = 0;
    Quality quality = Quality::kBad;

    void add(double value, Quality of_value);
  };
  using Means = std::array<std::vector<Mean>, kSignalKindCount>;

  [[nodiscard]] bool read_row(Frame& row);
  void take(const Frame& row, double elapsed);
  void give(Frame& frame) const;
  [[nodiscard]] double elapsed(const Frame& row) const;

  std::unique_ptr<RowSource> rows_;
  std::deque<Frame> read_;
  std::vector<std::string>& notices_;
  std::int64_t begin_ns_;
  double sample_time_ns_;
  double jitter_;     // intervals
  Means now_, next_;  // of interval at_, and of the one behind it, which has only CVs yet
  std::int64_t at_ = 0;
  std::optional<Frame> ahead_;  // the row that ended the last interval
  std::uint64_t left_out_ = 0;
};

/// Where the control intervals of such rows begin: at the moment of the interval at which the MVs
/// move, if all that are seen to move do so there; nothing where they do not tell.
[[nodiscard]] std::optional<std::int64_t> moves_at(const std::deque<Frame>& rows, double step_s,
                                                   double sample_time_s);

}  // namespace mpm::files
