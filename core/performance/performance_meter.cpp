#include "core/performance/performance_meter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mpm {

PerformanceMeter::PerformanceMeter(PerformanceSetup setup)
    : setup_(std::move(setup)),
      predictions_(setup_.counts.cv, setup_.horizons),
      mvs_(static_cast<std::size_t>(setup_.counts.mv)) {}

void PerformanceMeter::take(const Frame& frame, PerformanceSums& sums) {
  const bool next = begun_ && frame.interval == interval_ + 1;
  begun_ = true;
  interval_ = frame.interval;
  ++sums.samples;
  for (int j = 0; j < setup_.counts.cv; ++j)
    take_cv(frame, j, sums.cvs[static_cast<std::size_t>(j)]);
  take_mvs(frame, next, sums);
}

void PerformanceMeter::take_cv(const Frame& frame, int cv, CvSums& sums) const {
  const SignalBlock& measured = frame[SignalKind::kCv];
  const SignalBlock& setpoint = frame[SignalKind::kSetpoint];
  if (!measured.usable(cv)) return;
  const double value = measured.values(cv);
  ++sums.known;
  if (setup_.cv_limits[static_cast<std::size_t>(cv)].outside(value)) ++sums.outside;
  if (setpoint.usable(cv)) sums.error.take(value - setpoint.values(cv));
}

void PerformanceMeter::take_mvs(const Frame& frame, bool next, PerformanceSums& sums) {
  const SignalBlock& block = frame[SignalKind::kMv];
  bool acts = false, all_known = true;
  for (std::size_t i = 0; i < mvs_.size(); ++i) {
    Trace& trace = mvs_[i];
    const bool followed = next && trace.known;
    trace.known = block.usable(static_cast<int>(i));
    if (!trace.known) {
      all_known = false;
      continue;
    }
    const double value = block.values(static_cast<Eigen::Index>(i));
    const SignalLimits& limits = setup_.mv_limits[i];
    MvSums& mv = sums.mvs[i];
    trace.run.take(value);
    const bool low = limits.at_low(value), high = limits.at_high(value);
    ++mv.known;
    mv.at_low += low ? 1 : 0;
    mv.at_high += high ? 1 : 0;
    mv.at_limits += low || high ? 1 : 0;
    mv.standing += trace.run.stands() ? 1 : 0;
    if (followed) {
      ++mv.moves;
      mv.travel += std::abs(value - trace.last);
    }
    trace.last = value;
    acts = acts || !trace.run.stands();
  }
  // Where an MV is unknown, the others' rest does not say that it rests as well.
  if (!acts && !all_known) return;
  ++sums.told;
  sums.acting += acts ? 1 : 0;
}

void PerformanceMeter::judge(const JudgedFrame& judged, PerformanceSums& sums) {
  predictions_.push(judged.interval, judged.readings,
                    [&](std::size_t cv, std::size_t horizon) -> PredictionSums& {
                      return sums.cvs[cv].predictions[horizon];
                    });
}

void PerformanceMeter::begin_run() {
  predictions_.forget();
  std::fill(mvs_.begin(), mvs_.end(), Trace());
  begun_ = false;
}

}  // namespace mpm
