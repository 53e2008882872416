#pragma once

#include <cstdint>
#include <vector>

#include "core/performance/moments.hpp"
#include "core/performance/prediction_errors.hpp"
#include "core/performance/signal_limits.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

/// What the indices of a unit are told by.
struct PerformanceSetup {
  SignalCounts counts;
  std::vector<SignalLimits> mv_limits;  ///< one per MV; hard
  std::vector<SignalLimits> cv_limits;  ///< one per CV; soft
  std::vector<std::int64_t> horizons;   ///< of predictions, samples, >= 1, ascending
};

struct CvSums {
  std::int64_t known = 0;                   ///< samples in which it was measured
  Moments error;                            ///< measured minus set-point, where both are known
  std::int64_t outside = 0;                 ///< of the known: beyond a limit
  std::vector<PredictionSums> predictions;  ///< one per horizon

  template <class Archive>
  void archive(Archive& a) {
    a(known, error, outside, predictions);
  }
};

struct MvSums {
  std::int64_t known = 0;
  std::int64_t at_low = 0, at_high = 0, at_limits = 0;  ///< of the known; `at_limits`: at either
  std::int64_t standing = 0;                            ///< of the known: in a stand-still run
  std::int64_t moves = 0;                               ///< pairs of known values, one sample apart
  double travel = 0.0;  ///< sum of the absolute differences of these, MV units

  template <class Archive>
  void archive(Archive& a) {
    a(known, at_low, at_high, at_limits, standing, moves, travel);
  }
};

/// All that indices of control performance are made from: sums over some samples, which add up.
struct PerformanceSums {
  explicit PerformanceSums(const PerformanceSetup& setup);

  std::int64_t samples = 0;
  std::int64_t told = 0;    ///< of these: it is known whether the controller acts
  std::int64_t acting = 0;  ///< of these: it does
  std::vector<CvSums> cvs;
  std::vector<MvSums> mvs;

  /// Of the same unit. No allocation.
  void add(const PerformanceSums& other);
  void clear();

  template <class Archive>
  void archive(Archive& a) {
    a(samples, told, acting, cvs, mvs);
  }
};

/// `part` of `all`, 0..1; NaN of nothing.
[[nodiscard]] double share_of(std::int64_t part, std::int64_t all);

}  // namespace mpm
