#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/identify/causes/catalog.hpp"
#include "sim/signals/random_stream.hpp"
#include "tests/hidden/cv_noise.hpp"
#include "tests/hidden/effect_class.hpp"
#include "tests/hidden/true_plant.hpp"

namespace mpm::hidden {

/// One thing that is hidden, in the words of the contract.
struct TrueEffect {
  const Cause* cause = nullptr;  ///< null = nothing that the contract names
  Place place = {};
  std::string manner = {};  ///< of what has no cause: what it is
  int other_input = -1;     ///< that it goes with too
  /// Plant against model, with the names and units of the findings: gain_ratio,
  /// time_constant_ratio, dead_time_error (s), band, jump, width, low, high (input or CV units),
  /// quadratic, cubic, per_unit, gain, time_constant, dead_time (s), size (of a drift: by the end
  /// of the fitted part), rate (CV units per s), period (s), variance_ratio.
  std::map<std::string, double> parameters = {};
  std::optional<double> onset_s = {};  ///< clock of the data
};

enum class Size { kFull, kHalf };
enum class Setting { kPlain, kHard };

/// What the sizes of effects are measured against: the same loop with nothing hidden.
struct Healthy {
  std::vector<double> mv_low, mv_high;         ///< 2 % and 98 % of each MV's deviations
  std::vector<std::vector<double>> cv_sorted;  ///< measured
};

/// A hidden plant while it is being drawn.
struct Draft {
  const config::UnitConfig& unit;
  const Healthy& healthy;
  double size = 1.0;  ///< share of the full deviation
  bool hard = false;
  int samples = 0, fit_samples = 0;
  double start_s = 0.0;
  sim::RandomStream stream;

  TruePlantSpec plant;
  std::vector<CvNoise> noise;
  Eigen::MatrixXd aux;
  std::vector<TrueEffect> truth = {};

  [[nodiscard]] int mv_count() const { return static_cast<int>(unit.mv.size()); }
  [[nodiscard]] double between(double low, double high) {
    return low + (high - low) * stream.uniform();
  }
  [[nodiscard]] bool chance(double share) { return stream.uniform() < share; }
  [[nodiscard]] double sign() { return chance(0.5) ? 1.0 : -1.0; }
  [[nodiscard]] int below(int count) {
    return static_cast<int>(stream.below(static_cast<std::uint64_t>(count)));
  }
  [[nodiscard]] double range_of(int mv) const {
    return healthy.mv_high[static_cast<std::size_t>(mv)] -
           healthy.mv_low[static_cast<std::size_t>(mv)];
  }
  [[nodiscard]] double noise_of(int cv) const {
    return noise[static_cast<std::size_t>(cv)].deviation();
  }
  /// A sample inside the part that is fitted, as shares of that part.
  [[nodiscard]] int onset_between(double first, double last) {
    return static_cast<int>(between(first, last) * fit_samples);
  }
  [[nodiscard]] double seconds(double samples_) const { return samples_ * unit.sample_time_s; }
  [[nodiscard]] double clock(int k) const { return start_s + seconds(k); }
};

/// Whether reports call both the same, whatever their kinds. Neither is null.
[[nodiscard]] inline bool same_name(const Cause* one, const Cause* other) {
  return &one->name() == &other->name();
}

// Each hides one effect of its class in the draft and adds it to the truth.
void hide_in_channel(Draft& draft, EffectClass effect_class);  ///< gain .. output_scale, onset_*
void hide_input_nonlinearity(Draft& draft);
void hide_stiction(Draft& draft);
void hide_input_stuck(Draft& draft);
void hide_input_offset(Draft& draft);
void hide_output_nonlinearity(Draft& draft);
void hide_unmodelled_input(Draft& draft);  ///< behind one of the aux signals
void hide_disturbance(Draft& draft, EffectClass shape);
void hide_noise(Draft& draft);
void hide_unnamed(Draft& draft);
void hide_product(Draft& draft);

/// One of an MV that is not too quick for its samples.
[[nodiscard]] TrueChannel& any_slow_channel(Draft& draft);

/// Any class but none and two_causes.
void hide(Draft& draft, EffectClass effect_class);

/// What two_causes draws from.
inline constexpr std::array kSingleCauses = {EffectClass::kGain,
                                             EffectClass::kDeadTime,
                                             EffectClass::kTimeConstant,
                                             EffectClass::kInputScale,
                                             EffectClass::kOutputScale,
                                             EffectClass::kInputNonlinearity,
                                             EffectClass::kStiction,
                                             EffectClass::kOutputNonlinearity,
                                             EffectClass::kUnmodelledInput,
                                             EffectClass::kStep,
                                             EffectClass::kDrift,
                                             EffectClass::kPeriodic,
                                             EffectClass::kNoise};

/// Whether two effects act on different channels and are different causes, so that both can be
/// named.
[[nodiscard]] bool separable(const TrueEffect& one, const TrueEffect& other);

}  // namespace mpm::hidden
