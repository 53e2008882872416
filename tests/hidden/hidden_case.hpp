#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"
#include "tests/hidden/draft.hpp"
#include "tests/hidden/effect_class.hpp"

/// Plants with something hidden in them, to score `diagnose` on.
///
/// Seeds below 1000 score and must not be looked at while anything is being tuned; whoever tunes
/// takes seeds from 100001 on.
namespace mpm::hidden {

struct CaseRequest {
  std::string plant = "shell3x3";  ///< file in config/plants
  EffectClass effect_class = EffectClass::kNone;
  Size size = Size::kFull;  ///< half = half the deviation of the same draw
  Setting setting = Setting::kPlain;
  std::uint64_t seed = 100001;
  int samples = 3000;
};

struct HiddenCase {
  CaseRequest request;
  ModelSpec model;  ///< what the controller believes
  int mv_count = 0;
  Recording data;
  std::vector<TrueEffect> truth;  ///< empty = nothing hidden
  // What nobody can know.
  Eigen::MatrixXd noise;       ///< samples x CVs; is in data.cvs
  Eigen::MatrixXd noise_free;  ///< the true plant with its disturbances, driven by data.inputs
  std::vector<CvNoise> noise_model;
  TruePlantSpec plant, healthy_plant;  ///< with and without the effects; both with the background
  std::vector<double> evidence;        ///< of each effect in the fitted part; see `evidence`
  int attempts = 1;                    ///< draws until the loop stood it and the effect showed

  [[nodiscard]] Eigen::Index fit_samples() const { return 2 * data.samples() / 3; }
};

/// The same request gives the same case. With the hard setting every channel that the effect leaves
/// alone is wrong by a Gaussian 2 % in gain and 3 % in time constant (cut at two s.d.), each CV has
/// ARMA noise of its own, in a third of the seeds with heavy tails, and the effect has a shape that
/// is only near what a fit would take.
///
/// Drawn anew is what the loop cannot stand, what clips out of measure, and what does not show:
/// `evidence` below 100 at full and 25 at half size, or of a part of dynamics below 60 and 25, in
/// 3000 samples; in fewer as much less. Throws std::runtime_error where the unit file cannot be
/// read or no draw was fit.
[[nodiscard]] HiddenCase draw_case(const CaseRequest& request);

/// The plants that cases are drawn from.
inline constexpr std::array kPlants = {"shell3x3", "wood_berry", "shell7x5"};

}  // namespace mpm::hidden
