#pragma once

#include <Eigen/Core>
#include <vector>

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

/// What each effect adds to the CVs in the fitted part, in the sense of `evidence`; `stages` are
/// the plants with none, one, ... of them. 0 for a noise change, which adds nothing that has a
/// mean: whoever knows its size and onset cannot miss it.
[[nodiscard]] std::vector<double> evidence_of(const Draft& draft,
                                              const std::vector<TruePlantSpec>& stages,
                                              const LoopRecord& record, const Surroundings& around);

/// Of the errors that make up `dynamics` in one channel the least evidence that one has which the
/// others cannot stand for.
[[nodiscard]] double weakest_part(const Draft& draft, const TruePlantSpec& healthy,
                                  const TruePlantSpec& plant, const LoopRecord& record,
                                  const Surroundings& around);

}  // namespace mpm::hidden
