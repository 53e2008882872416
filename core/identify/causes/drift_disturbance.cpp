#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kRate{"rate", Form::kPlain, Unit::kCvPerSecond};

/// Onsets looked at: the beginning, and every twentieth of the data up to where what is left is too
/// short to show a drift.
constexpr int kDriftDisturbanceOnsets = 18;
constexpr double kOnsetStep = 0.05;
/// s.d. of what it comes to by the end, and a step of its finite difference, in s.d. of what is
/// left of the CV.
constexpr double kDriftDisturbanceUsualSize = 3.0, kDriftDisturbanceSizeStep = 0.05;

/// A CV wanders off at a constant rate.
class DriftDisturbance : public OutputDisturbance {
 public:
  DriftDisturbance() : OutputDisturbance("drift") {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    DisturbanceTerm term;
    term.cv = effect.place.cv;
    term.shape = DisturbanceShape::kDrift;
    term.onset_s = onset_s(effect, surroundings);
    term.size = effect.value(kRate, 0.0);
    model.disturbances.push_back(term);
  }
  [[nodiscard]] bool knows_onset() const override { return true; }
  [[nodiscard]] bool may_pass_for_noise() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const Eigen::Index samples = outlook.problem.samples();
    const double members = cost_of(static_cast<std::size_t>(outlook.model().cv_count));
    for (const CvFit& without : outlook.without) {
      const double sd = left_sd(without);
      for (int i = 0; i < kDriftDisturbanceOnsets; ++i) {
        const auto onset = static_cast<Eigen::Index>(static_cast<double>(samples) * kOnsetStep * i);
        const double length = static_cast<double>(samples - onset) * outlook.sample_time_s();
        found.push_back(effect({without.cv},
                               {{.quantity = &kRate,
                                 .prior_sd = kDriftDisturbanceUsualSize * sd / length,
                                 .step = kDriftDisturbanceSizeStep * sd / length,
                                 .low = -kUnboundedSize,
                                 .high = kUnboundedSize}},
                               members + cost_of(i == 0 ? 1 : kDriftDisturbanceOnsets), onset));
      }
    }
  }

  /// What it has come to by the end of the data that were fitted.
  void restate(const Effect& mine, const Problem& problem, Finding& finding) const override {
    const double length =
        static_cast<double>(problem.samples() - mine.onset) * problem.surroundings().sample_time_s;
    const Parameter rate = finding.parameters[0];
    finding.parameters.insert(finding.parameters.begin(),
                              {&kSize, rate.value * length, rate.low * length, rate.high * length});
    finding.onset_s = onset_s(mine, problem.surroundings());
  }

 protected:
  [[nodiscard]] std::string what_it_does(const Finding& finding,
                                         const SignalNames& names) const override {
    return "drifts " + up_or_down(finding, names) + " until the end of the data" +
           (finding.late ? "" : " that were fitted");
  }
};

}  // namespace

const Cause& drift_disturbance() {
  static const DriftDisturbance cause;
  return cause;
}

}  // namespace mpm::causes
