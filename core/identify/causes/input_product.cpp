#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/text/number_text.hpp"

namespace mpm::causes {
namespace {

/// u acts like (linear + per_unit dv) du, du and dv from the operating point, v the other input.
constexpr Quantity kInputProductLinear{"linear", Form::kPlain, Unit::kNone};
constexpr Quantity kPerUnit{"per_unit", Form::kPlain, Unit::kNone};

/// What an input does goes with where another one stands.
class InputProduct : public InputBlockCause {
 public:
  InputProduct() : InputBlockCause(kInputNonlinearity, "product") {}

  [[nodiscard]] bool is_curve() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : block_places(outlook))
      for (int other = 0; other < outlook.inputs(); ++other) {
        if (other == at.place.input) continue;
        const std::optional<Spread> spread = spread_of(outlook.recording().inputs.col(other));
        if (!spread) continue;
        const double reach = spread->reach_from(outlook.model().input_origin(other));
        const Coordinate per_unit = bending(kPerUnit, kBend / reach);
        found.push_back(
            effect(at.place, {plain_ratio(kInputProductLinear), per_unit},
                   cost_of(at.members) + cost_of(static_cast<std::size_t>(outlook.inputs() - 1))));
        found.back().other_input = other;
      }
  }

  [[nodiscard]] bool may_be_nothing(const Finding& finding) const override {
    return includes_nothing(*finding.find(kPerUnit));
  }

  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem& problem,
                                              const Tolerances&) const override {
    return as_gain(mine, accepted, accepted[mine].value(kInputProductLinear, 1.0), problem);
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const int other = finding.other_input;
    const SignalName with = other >= 0 ? names.input(other) : SignalName{"another input", ""};
    std::string text = "How much " + target(finding, names) + " answers " +
                       names.source(finding.subject.place).tag + " goes with where " + with.tag +
                       " stands";
    if (const Parameter* slope = finding.find(kPerUnit)) {
      const auto share = [](double value) {
        return (value > 0.0 ? "+" : "") + percent_text(value);
      };
      text += ": " + share(slope->value) + " (95 % interval " + share(slope->low) + " to " +
              share(slope->high) + ") of the model's gain per " +
              (with.unit.empty() ? "unit of it" : with.unit);
    }
    return text + ". ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    return Product{effect.other_input, effect.value(kPerUnit, 0.0),
                   effect.value(kInputProductLinear, 1.0)};
  }
};

}  // namespace

const Cause& input_product() {
  static const InputProduct cause;
  return cause;
}

}  // namespace mpm::causes
