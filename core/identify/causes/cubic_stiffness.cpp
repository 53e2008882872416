#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/measured_force.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/state_nonlinearity.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm::causes {
namespace {

/// phi = quadratic y^2 + cubic y^3, y the channel's deviation (RestoringForce).
constexpr Quantity kCubicStiffnessQuadratic{"quadratic", Form::kPlain, Unit::kNone};
constexpr Quantity kCubicStiffnessCubic{"cubic", Form::kPlain, Unit::kNone};

/// s.d. of each term where the CV is farthest out, as a share of the input's range.
constexpr double kCubicStiffnessUsualForce = 0.2;
constexpr double kCubicStiffnessStep = 0.02;  ///< of that s.d.

/// A CV is pushed back by a force that does not grow in proportion to it.
class CubicStiffness : public StateNonlinearity {
 public:
  CubicStiffness() : StateNonlinearity("cubic_stiffness") {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    edit_channels(effect, surroundings, model);
    model.state_terms.push_back({effect.place.cv, effect.place.input,
                                 RestoringForce{effect.value(kCubicStiffnessQuadratic, 0.0),
                                                effect.value(kCubicStiffnessCubic, 0.0)}});
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const StatePlace& at : state_places(outlook)) {
      const double origin = outlook.model().output_origin(at.channel->cv);
      const double reach = at.cv.reach_from(origin);
      const double range = at.input.range();
      const auto term = [](const Quantity& quantity, double sd) {
        return Coordinate{.quantity = &quantity,
                          .prior_sd = sd,
                          .step = kCubicStiffnessStep * sd,
                          .low = -kUnboundedSize,
                          .high = kUnboundedSize};
      };
      std::vector<Coordinate> force = {
          term(kCubicStiffnessQuadratic, kCubicStiffnessUsualForce * range / (reach * reach)),
          term(kCubicStiffnessCubic, kCubicStiffnessUsualForce * range / (reach * reach * reach))};
      std::vector<Coordinate> spring = {gain_ratio_coordinate(), time_constant_coordinate(0.0)};
      spring.insert(spring.end(), force.begin(), force.end());
      // A linear fit to a stiffening spring has got its damping wrong too.
      if (rings(*at.channel))
        spring.push_back(
            {.quantity = &kDampingRatio, .prior_sd = 0.35, .step = 0.01, .low = -2.0, .high = 2.0});
      const auto propose_both = [&] {
        found.push_back(effect(place_of(*at.channel), spring, members_cost(outlook)));
        found.push_back(effect(place_of(*at.channel), force, members_cost(outlook)));
      };
      propose_both();
      // Near where the force leaves the CV no rest, steps from zero end in runs without end.
      const Eigen::Vector2d start = measured_force(outlook, *at.channel);
      for (std::size_t i = 0; i < force.size(); ++i)
        spring[2 + i].value = force[i].value = start(static_cast<Eigen::Index>(i));
      propose_both();
    }
  }

  [[nodiscard]] bool may_be_nothing(const Finding& finding) const override {
    return includes_nothing(*finding.find(kCubicStiffnessQuadratic)) &&
           includes_nothing(*finding.find(kCubicStiffnessCubic));
  }

  /// One number or two before four: a channel that is off without a bend, or bends and is not off.
  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem&, const Tolerances&) const override {
    const Effect& spring = accepted[mine];
    if (!settles_channel(spring)) return {};
    const auto with = [&](const Cause& cause, std::vector<Coordinate> coordinates) {
      Effect plain = spring;
      plain.edit = &cause;
      plain.coordinates = std::move(coordinates);
      return Rewrite{{mine}, {plain}};
    };
    return {
        with(gain(), {*spring.find(kGainRatio)}),
        with(dynamics(), {*spring.find(kGainRatio), *spring.find(kTimeConstantRatio)}),
        with(*this, {*spring.find(kCubicStiffnessQuadratic), *spring.find(kCubicStiffnessCubic)})};
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return names.cv(finding.subject.place.cv).tag +
           " is pushed back by a force that does not grow in proportion to it (" + kind() + "). ";
  }
};

}  // namespace

const Cause& cubic_stiffness() {
  static const CubicStiffness cause;
  return cause;
}

}  // namespace mpm::causes
