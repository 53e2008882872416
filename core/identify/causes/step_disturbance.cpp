#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/step_moments.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kLag{"time_constant", Form::kPlain, Unit::kSeconds};

/// Moments of a step that are looked at more closely.
constexpr std::size_t kStepDisturbanceMoments = 8;
/// A moment is told from others some rows away.
constexpr std::size_t kStepDisturbanceRowsPerMoment = 4;
/// s.d. of the size, and a step of its finite difference, in s.d. of what is left of the CV.
constexpr double kStepDisturbanceUsualSize = 3.0, kStepDisturbanceSizeStep = 0.05;
/// Lags that it may come through, in slowest time constants of the CV, and what they never pass.
constexpr double kLags[] = {0.2, 0.7};
constexpr double kLagSd = 0.5, kLagStep = 0.01, kSlowestLag = 20.0;
constexpr double kFastestLag = 0.01;                   ///< samples
constexpr double kStepDisturbanceUsualSamples = 10.0;  ///< of a CV without a time constant

/// A CV jumps to another level, at once or through a lag, and stays there.
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
    model.disturbances.push_back(term);
  }
  [[nodiscard]] bool knows_onset() const override { return true; }
  [[nodiscard]] bool jumps() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double sample_time_s = outlook.sample_time_s();
    const auto samples = static_cast<std::size_t>(outlook.problem.samples());
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
      for (const Eigen::Index onset : step_moments(data, without, 0.0, kStepDisturbanceMoments))
        found.push_back(effect({without.cv}, {size}, cost, onset));
      const double slowest =
          slowest_of_cv_s(outlook.model(), without.cv, kStepDisturbanceUsualSamples);
      for (const double share : kLags) {
        const Coordinate lag{.quantity = &kLag,
                             .value = share * slowest,
                             .prior_mean = share * slowest,
                             .prior_sd = kLagSd * slowest,
                             .step = kLagStep * slowest,
                             .low = kFastestLag * sample_time_s,
                             .high = kSlowestLag * slowest};
        for (const Eigen::Index onset :
             step_moments(data, without, share * slowest / sample_time_s, kStepDisturbanceMoments))
          found.push_back(effect({without.cv}, {size, lag}, cost, onset));
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
    return "is shifted " + up_or_down(finding, names);
  }
};

const StepDisturbance& the_step() {
  static const StepDisturbance cause;
  return cause;
}

}  // namespace

const Cause& step_disturbance() { return the_step(); }

bool is_constant_offset(const Effect& effect) {
  return effect.edit == &the_step() && effect.onset == 0;
}

Effect constant_offset(int cv, double level, double noise_sd) {
  return the_step().offset(cv, level, noise_sd);
}

}  // namespace mpm::causes
