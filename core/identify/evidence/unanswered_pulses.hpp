#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// An input that jumps away and right back.
struct Pulse {
  int input = 0;
  Eigen::Index row = 0;   ///< first
  Eigen::Index rows = 1;  ///< how many are away
  double value = 0.0;     ///< farthest, own units
  double before = 0.0;    ///< the last value that was known before it

  [[nodiscard]] bool operator==(const Pulse&) const = default;
};

/// Those of at most `kLongestGlitch` rows that are far larger than the input's usual moves; none of
/// an input that moves so often that they are its usual moves. Whether the plant saw them, or only
/// the recorder did, they do not tell.
[[nodiscard]] std::vector<Pulse> short_pulses(const Recording& recording);

/// The same with their rows unknown (NaN).
[[nodiscard]] Recording without(Recording recording, const std::vector<Pulse>& pulses);

/// Those of `pulses` that the plant did not see: no CV that would show a quarter of the model's
/// answer shows as much. What no CV would show is not among them.
/// `model` in channels; `recording` without the pulses.
[[nodiscard]] std::vector<Pulse> unanswered(const ModelSpec& model, const Recording& recording,
                                            const std::vector<Pulse>& pulses);

}  // namespace mpm
