#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/step_moments.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kLag{"time_constant", Form::kPlain, Unit::kSeconds};
constexpr Quantity kDecay{"decay", Form::kLog, Unit::kSeconds};

/// Moments of a step that are looked at more closely.
constexpr std::size_t kStepDisturbanceMoments = 8, kPassingMoments = 4;
/// A moment is told from others some rows away.
constexpr std::size_t kStepDisturbanceRowsPerMoment = 4;
/// s.d. of the size, and a step of its finite difference, in s.d. of what is left of the CV.
constexpr double kStepDisturbanceUsualSize = 3.0, kStepDisturbanceSizeStep = 0.05;
/// Lags that it may come through, in slowest time constants of the CV, and what they never pass.
constexpr double kLags[] = {0.2, 0.7};
constexpr double kLagSd = 0.5, kLagStep = 0.01, kSlowestLag = 20.0;
constexpr double kFastestLag = 0.01;                   ///< samples
constexpr double kStepDisturbanceUsualSamples = 10.0;  ///< of a CV without a time constant
/// Time constants with which it may pass, in the data's length; s.d. of their logarithm; the least,
/// in samples, of what is no shock.
constexpr double kDecays[] = {0.015, 0.06};
constexpr double kUsualDecay = 0.03, kDecaySd = 1.2, kDecayStep = 0.02, kFastestDecay = 5.0;
constexpr double kDecaysApart = 2.0;  ///< from the onset of something else

/// What passes where something else begins in the CV is how that begins. `decay` in rows, 0: stays.
bool begins_with_another(const std::vector<Effect>& accepted, int cv, Eigen::Index onset,
                         double decay) {
  return std::any_of(accepted.begin(), accepted.end(), [&](const Effect& other) {
    return other.onset > 0 && cause_of(other).acts_through_channels() &&
           (other.place.cv < 0 || other.place.cv == cv) &&
           static_cast<double>(std::abs(other.onset - onset)) < kDecaysApart * decay;
  });
}

/// A CV jumps to another level, at once or through a lag, and stays there or comes back.
class StepDisturbance : public OutputDisturbance {
 public:
  StepDisturbance() : OutputDisturbance("step") {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    DisturbanceTerm term;
    term.cv = effect.place.cv;
    term.shape = DisturbanceShape::kStep;
    term.onset_s = onset_s(effect, surroundings);
    term.size = effect.value(kSize, 0.0);
    term.time_constant_s = effect.value(kLag, 0.0);
    if (const Coordinate* decay = effect.find(kDecay)) term.decay_s = std::exp(decay->value);
    model.disturbances.push_back(term);
  }
  [[nodiscard]] bool knows_onset() const override { return true; }
  [[nodiscard]] bool jumps() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double sample_time_s = outlook.sample_time_s();
    const auto samples = static_cast<std::size_t>(outlook.problem.samples());
    const auto rows = static_cast<double>(samples);
    const double cost = cost_of(static_cast<std::size_t>(outlook.model().cv_count)) +
                        cost_of(samples / kStepDisturbanceRowsPerMoment);
    for (const CvFit& without : outlook.without) {
      const CvData& data = outlook.problem.data(without.cv);
      const double sd = left_sd(without);
      const Coordinate size{.quantity = &kSize,
                            .prior_sd = kStepDisturbanceUsualSize * sd,
                            .step = kStepDisturbanceSizeStep * sd,
                            .low = -kUnboundedSize,
                            .high = kUnboundedSize};
      const double slowest =
          slowest_of_cv_s(outlook.model(), without.cv, kStepDisturbanceUsualSamples);
      const auto propose_form = [&](const StepForm& form) {
        std::vector<Coordinate> coordinates = {size};
        if (form.time_constant > 0.0)
          coordinates.push_back({.quantity = &kLag,
                                 .value = form.time_constant * sample_time_s,
                                 .prior_mean = form.time_constant * sample_time_s,
                                 .prior_sd = kLagSd * slowest,
                                 .step = kLagStep * slowest,
                                 .low = kFastestLag * sample_time_s,
                                 .high = kSlowestLag * slowest});
        if (form.decay > 0.0)
          coordinates.push_back({.quantity = &kDecay,
                                 .value = std::log(form.decay * sample_time_s),
                                 .prior_mean = std::log(kUsualDecay * rows * sample_time_s),
                                 .prior_sd = kDecaySd,
                                 .step = kDecayStep,
                                 .low = std::log(kFastestDecay * sample_time_s),
                                 .high = std::log(rows * sample_time_s)});
        const std::size_t moments = form.decay > 0.0 ? kPassingMoments : kStepDisturbanceMoments;
        for (const Eigen::Index onset : step_moments(data, without, form, moments))
          if (!begins_with_another(outlook.accepted, without.cv, onset, form.decay))
            found.push_back(effect({without.cv}, coordinates, cost, onset));
      };
      propose_form({});
      for (const double share : kLags) propose_form({share * slowest / sample_time_s});
      for (const double share : kDecays) {
        if (share * rows <= kFastestDecay) continue;
        propose_form({.decay = share * rows});
      }
    }
  }

  /// See output_disturbance.hpp.
  [[nodiscard]] Effect offset(int cv, double level, double noise_sd) const {
    return effect({cv},
                  {{.quantity = &kSize,
                    .value = level,
                    .prior_sd = noise_sd,
                    .step = 0.01 * noise_sd,
                    .low = -kNoLimit,
                    .high = kNoLimit}},
                  0.0);
  }

 protected:
  [[nodiscard]] std::string what_it_does(const Finding& finding,
                                         const SignalNames& names) const override {
    const Parameter* decay = finding.find(kDecay);
    if (decay == nullptr) return "is shifted " + up_or_down(finding, names);
    return "goes " + up_or_down(finding, names) + " and comes back with a time constant of " +
           number_text(decay->value) + " s";
  }
};

const StepDisturbance& the_step() {
  static const StepDisturbance cause;
  return cause;
}

}  // namespace

const Cause& step_disturbance() { return the_step(); }

bool passes(const Effect& effect) { return effect.find(kDecay) != nullptr; }

bool is_constant_offset(const Effect& effect) {
  return effect.edit == &the_step() && effect.onset == 0;
}

Effect constant_offset(int cv, double level, double noise_sd) {
  return the_step().offset(cv, level, noise_sd);
}

}  // namespace mpm::causes
