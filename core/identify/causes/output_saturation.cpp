#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/spread.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kOutputSaturationName{"output_nonlinearity", "Nonlinear output"};

constexpr Quantity kOutputSaturationLow{"low", Form::kPlain, Unit::kCv};
constexpr Quantity kOutputSaturationHigh{"high", Form::kPlain, Unit::kCv};

/// Shares of the data beyond a level to begin a fit from.
constexpr double kOutputSaturationBeyond[] = {0.002, 0.05, 0.12};
/// Successive values beyond a level that say how the CV moves there, and ratio of von Neumann below
/// which it moves slowly.
constexpr double kFewestBeyond = 20.0, kSlow = 0.5;
/// Ways in which a CV may overflow, beside which a level is picked.
constexpr int kLikes = 40;

/// A CV does not read, or does not go, beyond a level.
class OutputSaturation : public Cause {
 public:
  OutputSaturation() : Cause(kOutputSaturationName, "saturation") {}

  void apply(const Effect& effect, const Surroundings&, ModelSpec& model) const override {
    model.output_blocks[static_cast<std::size_t>(effect.place.cv)] =
        Saturation{effect.value(kOutputSaturationLow, -kNoLimit),
                   effect.value(kOutputSaturationHigh, kNoLimit)};
  }

  /// A clipped sensor would have shown its plateau: what is left is an overflow upstream of it.
  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const ModelSpec& model = outlook.model();
    const double members = cost_of(static_cast<std::size_t>(kLikes * model.cv_count));
    for (int cv = 0; cv < model.cv_count; ++cv) {
      if (model.output_blocks[static_cast<std::size_t>(cv)]) continue;
      const std::optional<Spread> spread = spread_of(outlook.recording().cvs.col(cv));
      if (!spread) continue;
      const double range = spread->sorted.back() - spread->sorted.front();
      const auto level = [&](const Quantity& quantity, double start) {
        return Coordinate{.quantity = &quantity,
                          .value = start,
                          .prior_mean = spread->median,
                          .prior_sd = 0.5 * range,
                          .step = 0.003 * range,
                          .low = -kUnbounded,
                          .high = kUnbounded};
      };
      for (const double p : kOutputSaturationBeyond) {
        found.push_back(
            effect({cv}, {level(kOutputSaturationHigh, spread->quantile(1.0 - p))}, members));
        found.push_back(effect({cv}, {level(kOutputSaturationLow, spread->quantile(p))}, members));
      }
    }
  }

  /// The plateaus of clipped sensors, told to the last digit.
  [[nodiscard]] std::vector<Effect> shown_by(const Problem& problem) const override {
    std::vector<Effect> found;
    for (int cv = 0; cv < problem.model().cv_count; ++cv) {
      const Plateaus& plateaus = problem.plateaus(cv);
      if (!plateaus.low && !plateaus.high) continue;
      const double sd = problem.data(cv).measured_sd;
      Effect clipping = effect({cv}, {}, 0.0);
      clipping.certain = true;
      const auto level = [&](const Quantity& quantity, double value) {
        clipping.coordinates.push_back({.quantity = &quantity,
                                        .value = value,
                                        .prior_mean = value,
                                        .prior_sd = 1e-6 * sd,
                                        .step = 1e-4 * sd,
                                        .low = -kNoLimit,
                                        .high = kNoLimit});
      };
      if (plateaus.low) level(kOutputSaturationLow, *plateaus.low);
      if (plateaus.high) level(kOutputSaturationHigh, *plateaus.high);
      found.push_back(std::move(clipping));
    }
    return found;
  }

  /// Beyond a level that it stops at a CV shows noise around it, and does not go on its way there:
  /// the ratio of von Neumann (1941), of the mean square difference of successive values to their
  /// variance, is 2 for white noise and near 0 for what moves slowly.
  [[nodiscard]] bool contradicted(const Effect& mine, const Problem& problem) const override {
    const auto values = problem.recording().cvs.col(mine.place.cv);
    const double low = mine.value(kOutputSaturationLow, -kNoLimit),
                 high = mine.value(kOutputSaturationHigh, kNoLimit);
    const auto beyond = [&](double value) { return value < low || value > high; };
    double count = 0.0, sum = 0.0, squares = 0.0, steps = 0.0, differences = 0.0;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      if (!beyond(values(k))) continue;
      count += 1.0;
      sum += values(k);
      squares += values(k) * values(k);
      if (k == 0 || !beyond(values(k - 1))) continue;
      steps += 1.0;
      differences += (values(k) - values(k - 1)) * (values(k) - values(k - 1));
    }
    if (steps < kFewestBeyond) return false;
    const double mean = sum / count;
    return differences / steps < kSlow * (squares / count - mean * mean);
  }

  /// A level that nothing reaches is not proposed.
  [[nodiscard]] bool may_be_nothing(const Finding&) const override { return false; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const int cv = finding.subject.place.cv;
    std::string text = names.cv(cv).tag + " does not read";
    const auto known = [](const Parameter* level) {
      return level != nullptr && std::isfinite(level->value);
    };
    const Parameter* low = finding.find(kOutputSaturationLow);
    const Parameter* high = finding.find(kOutputSaturationHigh);
    if (known(low)) text += " below " + names.in_cv(low->value, cv);
    if (known(low) && known(high)) text += " nor";
    if (known(high)) text += " above " + names.in_cv(high->value, cv);
    return text + ": a clipped sensor or an overflow. ";
  }
};

}  // namespace

const Cause& output_saturation() {
  static const OutputSaturation cause;
  return cause;
}

}  // namespace mpm::causes
