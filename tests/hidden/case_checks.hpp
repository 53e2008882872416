#pragma once

#include <Eigen/Core>

#include "config/unit_config.hpp"
#include "tests/hidden/draft.hpp"
#include "tests/hidden/loop.hpp"
#include "tests/hidden/true_plant.hpp"

/// Why a draw is thrown away.
namespace mpm::hidden {

/// Gains that an offset-free controller with the model can hold, with the margin that mpmsim's own
/// draws keep.
[[nodiscard]] bool is_stabilisable(const config::UnitConfig& unit, const TruePlantSpec& model,
                                   const TruePlantSpec& plant);

/// Not finite, or an MV three times, or a CV four times as far from its operating point as ever in
/// the healthy loop.
[[nodiscard]] bool runs_away(const LoopRecord& record, const LoopRecord& healthy,
                             const TruePlantSpec& plant);

/// A clipped CV meets its limits in 3 .. 20 % of the fitted samples at full size.
[[nodiscard]] bool clips_in_measure(const Draft& draft, const Eigen::MatrixXd& cvs);

/// What the instruments would have shown with the recorded inputs and the same noise.
[[nodiscard]] Eigen::MatrixXd measured_by(const TruePlantSpec& spec, const LoopRecord& record,
                                          const Surroundings& around);

}  // namespace mpm::hidden
