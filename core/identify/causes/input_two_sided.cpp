#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

constexpr Quantity kAt{"at", Form::kPlain, Unit::kInput};
constexpr Quantity kAbove{"above", Form::kPlain, Unit::kNone};
constexpr Quantity kBelow{"below", Form::kPlain, Unit::kNone};

/// Shares of the data below the point to begin a fit from; it stays within the first and last.
constexpr double kInputTwoSidedStarts[] = {0.3, 0.5, 0.7};
constexpr double kLeastBelow = 0.1, kMostBelow = 0.9;
/// Levels of the input: three lie on two lines whatever the plant does, and so do five, where the
/// point may lie anywhere between.
constexpr int kLevels = 6;

/// What an input does differs on the two sides of a point.
class InputTwoSided : public InputBlockCause {
 public:
  InputTwoSided() : InputBlockCause(kInputNonlinearity, "two_sided") {}

  [[nodiscard]] bool is_curve() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : curve_places(outlook, kLevels)) {
      const double range = at.input.range();
      for (const double share : kInputTwoSidedStarts) {
        const Coordinate point{.quantity = &kAt,
                               .value = at.input.quantile(share),
                               .prior_mean = at.input.median,
                               .prior_sd = 0.25 * range,
                               .step = 0.01 * range,
                               .low = at.input.quantile(kLeastBelow),
                               .high = at.input.quantile(kMostBelow)};
        found.push_back(effect(at.place, {point, plain_ratio(kBelow), plain_ratio(kAbove)},
                               cost_of(at.members)));
      }
    }
  }

  [[nodiscard]] int kinked_numbers() const override { return 1; }

  [[nodiscard]] bool may_be_nothing(const Finding& finding) const override {
    const Parameter &below = *finding.find(kBelow), &above = *finding.find(kAbove);
    return below.low <= above.high && above.low <= below.high;
  }

  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem& problem,
                                              const Tolerances&) const override {
    const Effect& sides = accepted[mine];
    return as_gain(mine, accepted, 0.5 * (sides.value(kBelow, 1.0) + sides.value(kAbove, 1.0)),
                   problem);
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const Parameter *at = finding.find(kAt), *below = finding.find(kBelow),
                    *above = finding.find(kAbove);
    std::string text = target(finding, names) + " does not answer " + names.source(place).tag +
                       " alike on both sides of ";
    if (at == nullptr || below == nullptr || above == nullptr) return text + "a point. ";
    return text + names.in_source(at->value, place) + " (" + interval_of(*at) + "): below " +
           number_text(below->value) + " times as much as the model says, above " +
           number_text(above->value) + " times. ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    return TwoSided{effect.value(kAbove, 1.0), effect.value(kBelow, 1.0), effect.value(kAt, 0.0)};
  }
};

}  // namespace

const Cause& input_two_sided() {
  static const InputTwoSided cause;
  return cause;
}

}  // namespace mpm::causes
