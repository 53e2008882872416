#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/input_block.hpp"

namespace mpm::causes {
namespace {

/// u acts like linear du + quadratic du^2 + cubic du^3, du from the operating point.
constexpr Quantity kInputPolynomialLinear{"linear", Form::kPlain, Unit::kNone};
constexpr Quantity kInputPolynomialQuadratic{"quadratic", Form::kPlain, Unit::kNone};
constexpr Quantity kInputPolynomialCubic{"cubic", Form::kPlain, Unit::kNone};

/// Levels of the input that a parabola and an offset go through, whatever the plant does.
constexpr int kLevelsOfSquare = 3;

/// A smooth curve between an input and what the plant sees of it.
class InputPolynomial : public InputBlockCause {
 public:
  InputPolynomial() : InputBlockCause(kInputNonlinearity, "polynomial") {}

  [[nodiscard]] bool is_curve() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : curve_places(outlook)) {
      const double reach = at.input.reach_from(outlook.model().input_origin(at.place.input));
      const Coordinate linear = plain_ratio(kInputPolynomialLinear);
      const Coordinate quadratic = bending(kInputPolynomialQuadratic, kBend / reach);
      const Coordinate cubic = bending(kInputPolynomialCubic, kBend / (reach * reach));
      found.push_back(effect(at.place, {linear, quadratic}, cost_of(at.members)));
      if (at.input.levels() > kLevelsOfSquare)
        found.push_back(effect(at.place, {linear, quadratic, cubic}, cost_of(at.members)));
    }
  }

  [[nodiscard]] bool may_be_nothing(const Finding& finding) const override {
    const Parameter* cubic = finding.find(kInputPolynomialCubic);
    return includes_nothing(*finding.find(kInputPolynomialQuadratic)) &&
           (cubic == nullptr || includes_nothing(*cubic));
  }

  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem& problem,
                                              const Tolerances&) const override {
    return as_gain(mine, accepted, accepted[mine].value(kInputPolynomialLinear, 1.0), problem);
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return target(finding, names) + " does not answer " + names.source(finding.subject.place).tag +
           " in proportion: the answer to a large move is not a small one's, enlarged. ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    Polynomial polynomial;
    polynomial.coefficients = {effect.value(kInputPolynomialLinear, 1.0),
                               effect.value(kInputPolynomialQuadratic, 0.0),
                               effect.value(kInputPolynomialCubic, 0.0)};
    while (polynomial.coefficients.size() > 1 && polynomial.coefficients.back() == 0.0)
      polynomial.coefficients.pop_back();
    return polynomial;
  }
};

}  // namespace

const Cause& input_polynomial() {
  static const InputPolynomial cause;
  return cause;
}

}  // namespace mpm::causes
