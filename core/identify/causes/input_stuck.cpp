#include "core/identify/causes/actuator_moments.hpp"
#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kInputStuckName{"input_stuck", "Stuck actuator"};

constexpr Quantity kValue{"value", Form::kPlain, Unit::kInput};

/// Moments that are looked at more closely; one is told from others some rows away.
constexpr std::size_t kInputStuckMoments = 8;
constexpr std::size_t kInputStuckRowsPerMoment = 4;
/// s.d. of where it sticks about the input's median, and a step of its finite difference, as shares
/// of the input's range.
constexpr double kUsualDistance = 1.0, kValueStep = 0.01;

/// An actuator stays where it is, whatever is commanded: from a moment on, or throughout.
class StuckActuator : public InputBlockCause {
 public:
  StuckActuator() : InputBlockCause(kInputStuckName) {}

  [[nodiscard]] bool knows_onset() const override { return true; }
  /// A command that runs away from a stuck actuator drives the simulation off, slowly.
  [[nodiscard]] bool may_pass_for_noise() const override { return true; }
  [[nodiscard]] bool has_onset_parameter() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const auto samples = static_cast<std::size_t>(outlook.problem.samples());
    const double members = cost_of(static_cast<std::size_t>(outlook.inputs()));
    for (const BlockPlace& at : block_places(outlook)) {
      if (!at.whole_input) continue;
      const Place place{-1, at.place.input};
      const auto value = [&](double start) {
        return Coordinate{.quantity = &kValue,
                          .value = start,
                          .prior_mean = at.input.median,
                          .prior_sd = kUsualDistance * at.input.range(),
                          .step = kValueStep * at.input.range()};
      };
      found.push_back(effect(place, {value(at.input.median)}, members));
      for (const ActuatorMoment& moment : stuck_moments(outlook, place.input, kInputStuckMoments))
        found.push_back(effect(place, {value(moment.value)},
                               members + cost_of(samples / kInputStuckRowsPerMoment),
                               moment.onset));
    }
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const Parameter* value = finding.find(kValue);
    std::string text = "The actuator of " + names.source(place).tag + " is stuck";
    if (value != nullptr)
      text += " at " + names.in_source(value->value, place) + " (" +
              interval_of(*value, names.source(place).unit) + ")";
    text += ", whatever is commanded. ";
    const int cv = only_cv(names.model, place.input);
    if (cv >= 0 && !finding.onset_s)
      text += "Only " + names.cv(cv).tag +
              " would answer it, so that a channel without any gain looks the same. ";
    return text;
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect,
                                 const Surroundings& surroundings) const override {
    return Stuck{effect.value(kValue, 0.0), since_s(effect, surroundings)};
  }
};

}  // namespace

const Cause& input_stuck() {
  static const StuckActuator cause;
  return cause;
}

}  // namespace mpm::causes
