#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/state_nonlinearity.hpp"

namespace mpm::causes {
namespace {

/// Of a TankChain.
constexpr Quantity kEmptyInput{"empty_input", Form::kPlain, Unit::kInput};
constexpr Quantity kEmptyOutput{"empty_output", Form::kPlain, Unit::kCv};
constexpr Quantity kOverflow{"overflow", Form::kPlain, Unit::kNone};
constexpr Quantity kSpill{"spill", Form::kPlain, Unit::kNone};
/// Of each tank, plant against model.
constexpr Quantity kTankRatio{"time_constant_ratio", Form::kLog, Unit::kNone};

/// How far below the lowest level the tank is empty, in ranges of the CV, to begin a fit from.
constexpr double kDepths[] = {0.1, 0.5};
/// The input without flow is below the operating point, the empty level below the lowest, by at
/// least this share of what they move.
constexpr double kLeastInput = 0.02, kLeastDepth = 1e-3;

/// Tanks drain with the square root of their levels, and may overflow.
class SquareRootOutflowCause : public StateNonlinearity {
 public:
  SquareRootOutflowCause() : StateNonlinearity("square_root_outflow") {}

  void apply(const Effect& effect, const Surroundings&, ModelSpec& model) const override {
    for (ChannelSpec& channel : model.channels) {
      if (channel.cv != effect.place.cv || channel.input != effect.place.input) continue;
      const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
      if (transfer == nullptr) return;
      TankChain tanks;
      for (std::size_t n = 0; n < transfer->time_constants_s.size(); ++n) {
        const int number = static_cast<int>(n) + 1;
        tanks.time_constants_s.push_back(transfer->time_constants_s[n] *
                                         std::exp(effect.value(kTankRatio, 0.0, number)));
        tanks.overflow.push_back(
            effect.value(kOverflow, std::numeric_limits<double>::infinity(), number));
      }
      tanks.empty_input = effect.value(kEmptyInput, 0.0);
      tanks.empty_output = effect.value(kEmptyOutput, 0.0);
      tanks.spill = effect.value(kSpill, 0.0);
      tanks.dead_time_s = transfer->dead_time_s;
      channel.dynamics = tanks;
    }
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const StatePlace& at : state_places(outlook)) {
      const auto* transfer = std::get_if<TransferFunction>(&at.channel->dynamics);
      if (transfer == nullptr || transfer->lead_s != 0.0 || !(transfer->gain > 0.0)) continue;
      for (const double depth : kDepths) tanks(outlook, at, *transfer, depth, found);
    }
  }

  /// No value of its numbers makes it the linear model.
  [[nodiscard]] bool may_be_nothing(const Finding&) const override { return false; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return names.cv(finding.subject.place.cv).tag +
           " drains with the square root of its level, where the model drains in proportion: its "
           "gain and its time constants depend on the level. ";
  }

 private:
  /// Levels must stay positive, and the gain of tanks is 2 Y / U: one empty level gives the other.
  void tanks(const Outlook& outlook, const StatePlace& at, const TransferFunction& transfer,
             double depth, std::vector<Effect>& found) const {
    const double u0 = outlook.model().input_origin(at.channel->input);
    const double y0 = outlook.model().output_origin(at.channel->cv);
    const double span_u = at.input.sorted.back() - at.input.sorted.front();
    const double lowest_y = at.cv.sorted.front();
    const double empty_output = lowest_y - depth * (at.cv.sorted.back() - lowest_y);
    const double empty_input = u0 - 2.0 * (y0 - empty_output) / transfer.gain;
    if (!(u0 - empty_input > 0.0) || !(y0 - empty_output > 0.0)) return;
    const int count = static_cast<int>(transfer.time_constants_s.size());
    for (const bool overflow : {false, true}) {
      std::vector<Coordinate> coordinates = {{.quantity = &kEmptyInput,
                                              .value = empty_input,
                                              .prior_mean = u0 - span_u,
                                              .prior_sd = span_u,
                                              .step = 0.01 * span_u,
                                              .low = -kUnbounded,
                                              .high = u0 - kLeastInput * span_u},
                                             {.quantity = &kEmptyOutput,
                                              .value = empty_output,
                                              .prior_mean = empty_output,
                                              .prior_sd = at.cv.range(),
                                              .step = 0.01 * at.cv.range(),
                                              .low = -kUnbounded,
                                              .high = lowest_y - kLeastDepth * at.cv.range()}};
      for (int n = 1; n <= count; ++n)
        coordinates.push_back({.quantity = &kTankRatio,
                               .prior_sd = 0.5,
                               .step = 0.01,
                               .low = -2.0,
                               .high = 2.0,
                               .number = n});
      if (overflow) {
        for (int n = 1; n <= count; ++n)
          coordinates.push_back({.quantity = &kOverflow,
                                 .value = 1.8,
                                 .prior_mean = 2.0,
                                 .prior_sd = 1.0,
                                 .step = 0.01,
                                 .low = 1.01,
                                 .high = 20.0,
                                 .number = n});
        if (count > 1)
          coordinates.push_back({.quantity = &kSpill,
                                 .value = 0.3,
                                 .prior_mean = 0.5,
                                 .prior_sd = 0.3,
                                 .step = 0.02,
                                 .low = 0.0,
                                 .high = 1.0});
      }
      found.push_back(effect(place_of(*at.channel), std::move(coordinates), members_cost(outlook)));
    }
  }
};

}  // namespace

const Cause& square_root_outflow() {
  static const SquareRootOutflowCause cause;
  return cause;
}

}  // namespace mpm::causes
