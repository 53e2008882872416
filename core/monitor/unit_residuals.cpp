#include "core/monitor/unit_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mismatch/calibration.hpp"

namespace mpm {

UnitResiduals::UnitResiduals(int cvs)
    : values_(Eigen::VectorXd::Zero(cvs)),
      held_(Eigen::VectorXd::Zero(cvs)),
      largest_(Eigen::VectorXd::Zero(cvs)),
      unknown_runs_(static_cast<std::size_t>(cvs), 0) {}

void UnitResiduals::read(const Frame& frame, const Eigen::VectorXd& predicted) {
  const SignalBlock& measured = frame[SignalKind::kCv];
  for (int j = 0; j < static_cast<int>(values_.size()); ++j) {
    values_(j) = measured.usable(j) ? measured.values(j) - predicted(j)
                                    : std::numeric_limits<double>::quiet_NaN();
    std::int64_t& run = unknown_runs_[static_cast<std::size_t>(j)];
    run = std::isfinite(values_(j)) ? 0 : run + 1;
    if (run > 0) continue;
    largest_(j) = std::max(largest_(j), std::abs(measured.values(j)));
    if (std::abs(values_(j)) < calibration::kRounding * largest_(j)) values_(j) = 0.0;
    held_(j) = values_(j);
  }
}

void UnitResiduals::skip(std::int64_t missing) {
  for (std::int64_t& run : unknown_runs_) run += missing;
}

std::int64_t UnitResiduals::longest_unknown_run() const {
  return unknown_runs_.empty() ? 0 : *std::max_element(unknown_runs_.begin(), unknown_runs_.end());
}

}  // namespace mpm
