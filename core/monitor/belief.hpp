#pragma once

#include <limits>

#include "core/mismatch/channel_evidence.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {

/// Which evidence of a CV's channels counts at all.
struct Belief {
  double largest_index = std::numeric_limits<double>::infinity();  ///< of the excitation
  double p_value = 1.0;                                            ///< at most

  /// Whatever there is counts.
  [[nodiscard]] bool in_all() const { return p_value >= 1.0; }
  [[nodiscard]] bool has(const ChannelEvidence& evidence) const {
    return evidence.excitation_index <= largest_index && evidence.p_value <= p_value;
  }
};

/// Of a CV whose readings repeat in a share of all samples, 0..1: any, unless they are so coarse
/// that its errors are no noise. Then what is beyond doubt, of channels in which a gain error
/// of `gain_error_of_interest` (relative, > 0) would show; and none where hardly a reading differs
/// from the one before.
[[nodiscard]] constexpr Belief belief_in(double repeated_share, double gain_error_of_interest) {
  namespace coarse = calibration::coarse_readings;
  if (repeated_share < coarse::kRepeatedShare) return {};
  if (repeated_share > coarse::kMostlyRepeated) return {0.0, coarse::kNothingConvinces};
  return {gain_error_of_interest / calibration::visibility::kSeenDeviations,
          coarse::kConvincingPValue};
}

}  // namespace mpm
