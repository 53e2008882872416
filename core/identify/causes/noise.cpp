#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/noise_change.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kNoiseName{"noise", "Noise"};

constexpr Quantity kVarianceRatio{"variance_ratio", Form::kPlain, Unit::kOfModel};

/// What is beyond doubt is said with this confidence.
constexpr double kConfidence = 0.99;

/// Share of readings that are the one before from which on a CV is so coarse that its errors come
/// and go with its steps: as where the monitor doubts it (core/monitor, coarse_readings).
constexpr double kCoarse = 0.45;

bool is_coarse(const Eigen::Ref<const Eigen::VectorXd>& cv) {
  double same = 0.0, count = 0.0;
  for (Eigen::Index k = 1; k < cv.size(); ++k) {
    if (!std::isfinite(cv(k)) || !std::isfinite(cv(k - 1))) continue;
    same += cv(k) == cv(k - 1) ? 1.0 : 0.0;
    ++count;
  }
  return same > kCoarse * count;
}

/// A CV is louder or quieter from a moment on. No edit of the model: it is looked for in what the
/// last fit leaves.
class Noise : public Cause {
 public:
  Noise() : Cause(kNoiseName) {}

  void apply(const Effect&, const Surroundings&, ModelSpec&) const override {}

  [[nodiscard]] std::vector<Finding> left_in(const Problem& problem,
                                             const Fit& fit) const override {
    const Surroundings& surroundings = problem.surroundings();
    std::vector<Finding> found;
    for (const CvFit& of_cv : fit.cvs) {
      const std::optional<NoiseChange> change = find_noise_change(of_cv, problem.data(of_cv.cv));
      if (!change || is_coarse(problem.recording().cvs.col(of_cv.cv))) continue;
      Finding finding;
      finding.subject = {this, {of_cv.cv}};
      finding.parameters = {{&kVarianceRatio, change->ratio, change->low, change->high}};
      finding.evidence = change->z * change->z;
      if (!change->beyond_doubt()) {
        finding.evidence *= change->burstiness * change->burstiness;
        finding.refused = "it comes in bursts: structure is missing, or a historian has thinned it";
      }
      finding.confidence = kConfidence;
      finding.onset_s =
          surroundings.start_s + static_cast<double>(change->onset) * surroundings.sample_time_s;
      found.push_back(std::move(finding));
    }
    return found;
  }

  [[nodiscard]] bool has_onset_parameter() const override { return true; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Parameter* ratio = finding.find(kVarianceRatio);
    std::string text = "The noise on " + names.cv(finding.subject.place.cv).tag + " changed";
    if (ratio != nullptr)
      text += ": its variance is " + number_text(ratio->value) + " times what it was (" +
              interval_of(*ratio) + ")";
    return text + ". No repair of the model removes that. ";
  }
};

}  // namespace

const Cause& noise() {
  static const Noise cause;
  return cause;
}

}  // namespace mpm::causes
