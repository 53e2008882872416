#include "daemon/files/aligning.hpp"

#include <algorithm>

#include "core/signal/aligner.hpp"

namespace mpm::files {

std::array<bool, kSignalKindCount> needed_kinds(const config::UnitConfig& unit) {
  std::array<bool, kSignalKindCount> needed{};
  const auto need = [&](SignalKind kind, bool yes) {
    needed[static_cast<std::size_t>(kind)] = yes;
  };
  need(SignalKind::kMv, true);
  need(SignalKind::kCv, true);
  need(SignalKind::kDv, !unit.dv.empty());
  need(SignalKind::kPrediction,
       std::any_of(unit.cv.begin(), unit.cv.end(),
                   [](const config::CvSignal& cv) { return !cv.prediction.empty(); }));
  return needed;
}

std::chrono::nanoseconds frame_patience(const config::UnitConfig& unit) {
  using std::chrono::duration;
  const duration<double> lateness(unit.sample_time_s * AlignerSettings{}.max_lateness);
  return std::max<std::chrono::nanoseconds>(
      std::chrono::seconds(2), std::chrono::duration_cast<std::chrono::nanoseconds>(lateness));
}

}  // namespace mpm::files
