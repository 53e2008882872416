#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kInputSaturationLow{"low", Form::kPlain, Unit::kInput};
constexpr Quantity kInputSaturationHigh{"high", Form::kPlain, Unit::kInput};

/// Shares of the data beyond a level to begin a fit from.
constexpr double kInputSaturationBeyond[] = {0.03, 0.08, 0.15, 0.25};
/// A level that leaves less than this share of the data on either side is none any more.
constexpr double kLeastWithin = 0.3, kMostWithin = 0.7;

/// What an input asks for beyond a level has no effect.
class InputSaturation : public InputBlockCause {
 public:
  InputSaturation() : InputBlockCause(kInputNonlinearity, "saturation") {}

  [[nodiscard]] bool is_curve() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : curve_places(outlook)) {
      const double range = at.input.range();
      const auto level = [&](const Quantity& quantity, double start) {
        return Coordinate{.quantity = &quantity,
                          .value = start,
                          .prior_mean = at.input.median,
                          .prior_sd = 0.5 * range,
                          .step = 0.01 * range,
                          .low = -kUnbounded,
                          .high = kUnbounded};
      };
      for (const double p : kInputSaturationBeyond) {
        Coordinate high = level(kInputSaturationHigh, at.input.quantile(1.0 - p));
        Coordinate low = level(kInputSaturationLow, at.input.quantile(p));
        high.low = at.input.quantile(kLeastWithin);
        low.high = at.input.quantile(kMostWithin);
        found.push_back(effect(at.place, {high}, cost_of(at.members)));
        found.push_back(effect(at.place, {low}, cost_of(at.members)));
        found.push_back(effect(at.place, {low, high}, cost_of(at.members)));
      }
    }
  }

  [[nodiscard]] int kinked_numbers() const override { return 2; }

  /// A level that nothing reaches is not proposed.
  [[nodiscard]] bool may_be_nothing(const Finding&) const override { return false; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const Parameter* low = finding.find(kInputSaturationLow);
    const Parameter* high = finding.find(kInputSaturationHigh);
    const auto limit = [&](const Parameter& at) {
      return names.in_source(at.value, place) + " (" + interval_of(at) + ")";
    };
    std::string text = names.source(place).tag + " acts on " + target(finding, names) + " only";
    if (low != nullptr) text += " above " + limit(*low);
    if (low != nullptr && high != nullptr) text += " and";
    if (high != nullptr) text += " below " + limit(*high);
    return text + "; what it asks for beyond has no effect. ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    return Saturation{effect.value(kInputSaturationLow, -kNoLimit),
                      effect.value(kInputSaturationHigh, kNoLimit)};
  }
};

}  // namespace

const Cause& input_saturation() {
  static const InputSaturation cause;
  return cause;
}

}  // namespace mpm::causes
