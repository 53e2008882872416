#pragma once

#include <cstdint>
#include <vector>

#include "core/monitor/cv_reading.hpp"
#include "core/monitor/still_run.hpp"
#include "core/performance/performance_sums.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

/// Adds a unit's samples, one by one, to sums of whoever wants them. What is unknown or bad does
/// not count. No allocation after construction.
class PerformanceMeter {
 public:
  explicit PerformanceMeter(PerformanceSetup setup);

  [[nodiscard]] const PerformanceSetup& setup() const { return setup_; }
  /// Set-points, limits and moves of a frame that is newer than all before.
  void take(const Frame& frame, PerformanceSums& sums);
  /// Predictions: what the monitor read (`Monitor::judged`), of a later interval each time.
  void judge(const JudgedFrame& judged, PerformanceSums& sums);
  /// What follows is another run: no move and no prediction goes across, and its intervals may
  /// begin anywhere.
  void begin_run();

  template <class Archive>
  void archive(Archive& a) {
    // not archived: setup_ (construction)
    a(predictions_, mvs_, interval_, begun_);
  }

 private:
  /// One MV's last values.
  struct Trace {
    StillRun run;
    double last = 0.0;
    bool known = false;  // in the last interval
    template <class Archive>
    void archive(Archive& a) {
      a(run, last, known);
    }
  };

  void take_cv(const Frame& frame, int cv, CvSums& sums) const;
  void take_mvs(const Frame& frame, bool next, PerformanceSums& sums);

  PerformanceSetup setup_;
  PredictionErrors predictions_;
  std::vector<Trace> mvs_;
  std::int64_t interval_ = 0;  // of the last frame
  bool begun_ = false;
};

}  // namespace mpm
