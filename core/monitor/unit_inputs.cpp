#include "core/monitor/unit_inputs.hpp"

#include <algorithm>
#include <limits>

namespace mpm {

UnitInputs::UnitInputs(const SignalCounts& counts, double memory_samples)
    : mvs_(counts.mv),
      values_(Eigen::VectorXd::Zero(counts.inputs())),
      held_(Eigen::VectorXd::Zero(counts.inputs())),
      unknown_runs_(static_cast<std::size_t>(counts.inputs()), 0),
      motions_(static_cast<std::size_t>(counts.inputs()), InputMotion(memory_samples)) {}

void UnitInputs::read(const Frame& frame) {
  for (int i = 0; i < static_cast<int>(values_.size()); ++i) {
    const bool is_mv = i < mvs_;
    const SignalBlock& block = frame[is_mv ? SignalKind::kMv : SignalKind::kDv];
    const int at = is_mv ? i : i - mvs_;
    const auto s = static_cast<std::size_t>(i);
    if (block.usable(at)) {
      values_(i) = held_(i) = block.values(at);
      motions_[s].take(values_(i));
      unknown_runs_[s] = 0;
    } else {
      values_(i) = std::numeric_limits<double>::quiet_NaN();
      ++unknown_runs_[s];
    }
  }
}

std::int64_t UnitInputs::longest_unknown_run() const {
  return unknown_runs_.empty() ? 0 : *std::max_element(unknown_runs_.begin(), unknown_runs_.end());
}

bool UnitInputs::mvs_still() const {
  return std::all_of(motions_.begin(), motions_.begin() + mvs_,
                     [](const InputMotion& motion) { return motion.still(); });
}

}  // namespace mpm
