#pragma once

#include <cstdint>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/signal/frame.hpp"

namespace mpm {
class Archive;
}

namespace mpm::live {

/// A copy of the ring's rows, oldest first: MVs, DVs, CVs; NaN where a value is not known.
struct RingCopy {
  std::vector<double> values;
  SignalCounts counts;
  std::int64_t last_interval = 0;
  std::int64_t last_time_ns = 0;

  [[nodiscard]] Eigen::Index rows() const;
  /// The control intervals are the grid, and the last row's time is its time.
  [[nodiscard]] Recording recording(double sample_time_s) const;
};

/// What a unit measured in its last control intervals. All memory is there from the start, so that
/// a frame costs the copying of its values and nothing else.
class FrameRing {
 public:
  FrameRing(const SignalCounts& counts, int capacity);

  /// Frames come in increasing interval order; intervals between them become rows of NaN.
  void push(const Frame& frame);
  /// Two blocks of memory at most: some 0.1 ms for 6000 rows of ten signals.
  [[nodiscard]] RingCopy copy() const;

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int capacity() const { return capacity_; }

  void archive(Archive& a);

 private:
  [[nodiscard]] double* next_row();

  SignalCounts counts_;
  int width_;
  int capacity_;
  int rows_ = 0;
  int next_ = 0;  // row that the next frame is written to
  std::int64_t last_interval_ = 0;
  std::int64_t last_time_ns_ = 0;
  std::vector<double> values_;
};

}  // namespace mpm::live
