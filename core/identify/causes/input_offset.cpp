#include <cmath>

#include "core/identify/causes/actuator_moments.hpp"
#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kName{"input_offset", "Offset of an actuator"};

constexpr Quantity kSize{"size", Form::kPlain, Unit::kInput};

/// Moments that are looked at more closely; one is told from others some rows away.
constexpr std::size_t kMoments = 8;
constexpr std::size_t kRowsPerMoment = 4;
/// s.d. of the size, and a step of its finite difference, as shares of the input's range.
constexpr double kUsualSize = 0.3, kSizeStep = 0.01;
/// Load disturbances come in through like dynamics as often as actuators shift: where only one CV
/// answers, the shape of the onset must speak for the actuator by itself, 2 ln of odds. And what
/// wanders looks like steps of this and that.
constexpr double kOneCvOnly = 30.0;
constexpr double kWandering = 20.0;

/// An actuator is open by more than its command from a moment on: it leaks, or its zero has
/// shifted. An offset that is always there is a level of the CVs, which a model leaves free; it
/// is never taken for one.
class InputOffsetCause : public InputBlockCause {
 public:
  InputOffsetCause() : InputBlockCause(kName) {}

  [[nodiscard]] bool knows_onset() const override { return true; }
  [[nodiscard]] bool has_onset_parameter() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const auto samples = static_cast<std::size_t>(outlook.problem.samples());
    const double cost =
        cost_of(static_cast<std::size_t>(outlook.inputs())) + cost_of(samples / kRowsPerMoment);
    for (const BlockPlace& at : block_places(outlook)) {
      if (!at.whole_input) continue;
      const int input = at.place.input;
      const double range = at.input.range();
      const double shared = outlook.cvs_of(input).size() > 1 ? 0.0 : kOneCvOnly;
      for (const ActuatorMoment& moment : offset_moments(outlook, input, kMoments))
        found.push_back(effect({-1, input},
                               {{.quantity = &kSize,
                                 .value = moment.value,
                                 .prior_sd = kUsualSize * range,
                                 .step = kSizeStep * range}},
                               cost + shared + kWandering, moment.onset));
    }
  }

  /// The input need not move for it to show: it is a load on its CVs.
  [[nodiscard]] bool acts_through_channels() const override { return false; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const std::string& tag = names.source(place).tag;
    const Parameter* size = finding.find(kSize);
    std::string text =
        tag + " acts as if it were " +
        (size == nullptr ? "offset"
                         : names.in_source(std::abs(size->value), place) +
                               (size->value < 0.0 ? " lower" : " higher") + " (size " +
                               interval_of(*size, names.source(place).unit) + ")");
    text += ": its actuator leaks, or its zero has shifted. ";
    const int cv = only_cv(names.model, place.input);
    if (cv >= 0)
      text += "Only " + names.cv(cv).tag +
              " answers it, so that a disturbance that comes in the same way looks the same. ";
    return text;
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect,
                                 const Surroundings& surroundings) const override {
    return InputOffset{effect.value(kSize, 0.0), since_s(effect, surroundings)};
  }
};

}  // namespace

const Cause& input_offset() {
  static const InputOffsetCause cause;
  return cause;
}

}  // namespace mpm::causes
