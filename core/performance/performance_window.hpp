#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/performance/performance_meter.hpp"
#include "core/performance/plausible_frames.hpp"

namespace mpm {

class Archive;

/// Sums over the last samples of a unit: a sliding window of `calibration::performance::kBlocks`
/// equal blocks, counted in control intervals from the first frame on. No allocation after
/// construction.
class PerformanceWindow {
 public:
  /// `samples`: wanted, > 0; it has at least `kFewestSamples`, in blocks of as many each.
  PerformanceWindow(PerformanceSetup setup, double samples);

  [[nodiscard]] const PerformanceSetup& setup() const { return meter_.setup(); }
  /// Of a full window.
  [[nodiscard]] std::int64_t samples() const;

  /// A frame, and what the monitor judged with it (`Monitor::judged`). Whether a block has ended:
  /// with its last interval or, where that did not come, with the next one that did, once it is
  /// known which of their values are none of the process.
  bool push(const Frame& frame, std::span<const JudgedFrame> judged);
  /// Over the window; valid until the next call.
  [[nodiscard]] const PerformanceSums& total();

  void archive(Archive& a);

 private:
  [[nodiscard]] bool take(const Frame& frame);
  void slide_to(std::int64_t block);

  PlausibleFrames frames_;
  PerformanceMeter meter_;
  std::int64_t block_samples_;
  std::vector<PerformanceSums> blocks_;
  PerformanceSums total_;
  std::int64_t first_ = 0;  // interval
  std::int64_t block_ = 0;  // at hand, counted from the first
  std::int64_t last_ = 0;   // interval that was taken
  bool begun_ = false;
  bool open_ = false;  // the block at hand has not been told
};

}  // namespace mpm
