#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/causes/state_nonlinearity.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm::causes {
namespace {

/// Of a CoulombFriction: what it takes off the input, and the speed at which it is nearly full.
constexpr Quantity kForce{"force", Form::kPlain, Unit::kInput};
constexpr Quantity kSpeed{"speed", Form::kLog, Unit::kCvPerSecond};

/// Forces to begin a fit from, as shares of the input's range, and the prior's s.d.
constexpr double kCoulombFrictionStarts[] = {0.05, 0.15};
constexpr double kCoulombFrictionUsualForce = 0.15;
constexpr double kForceStep = 0.005;
/// Speeds to begin a fit from, in the CV's usual one by the model: friction is full long before it
/// moves so fast, but not so soon that the simulation chatters. s.d. of the log.
constexpr double kSpeeds[] = {0.1, 0.4};
constexpr double kSpeedSd = 1.0, kSpeedStep = 0.05, kSpeedReach = 3.0;

/// Root mean square of how fast the CV moves by what is known of it, CV units per s.
double usual_speed(const Outlook& outlook, int cv) {
  const Eigen::VectorXd simulated = outlook.problem.simulate(outlook.accepted, cv);
  const Eigen::Index moves = simulated.size() - 1;
  const double square = (simulated.tail(moves) - simulated.head(moves)).squaredNorm();
  return std::sqrt(square / static_cast<double>(moves)) / outlook.sample_time_s();
}

/// Whether a channel has inertia: without, dry friction is the same as play of its input, which
/// goes by that name.
bool has_inertia(const ChannelSpec& channel) {
  const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
  return rings(channel) ||
         (transfer != nullptr && transfer->integrating && !transfer->time_constants_s.empty());
}

/// Dry friction holds a CV back: a force against its motion, however slow.
class DryFriction : public StateNonlinearity {
 public:
  DryFriction() : StateNonlinearity("coulomb_friction") {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    edit_channels(effect, surroundings, model);
    model.state_terms.push_back(
        {effect.place.cv, effect.place.input,
         CoulombFriction{effect.value(kForce, 0.0), std::exp(effect.value(kSpeed, 0.0))}});
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const StatePlace& at : state_places(outlook, true)) {
      if (!has_inertia(*at.channel)) continue;
      const double range = at.input.range();
      const double usual = usual_speed(outlook, at.channel->cv);
      if (!(usual > 0.0)) continue;
      for (const double share : kCoulombFrictionStarts)
        for (const double of_usual : kSpeeds) {
          const double speed = std::log(of_usual * usual);
          const Coordinate force{.quantity = &kForce,
                                 .value = share * range,
                                 .prior_mean = 0.0,
                                 .prior_sd = kCoulombFrictionUsualForce * range,
                                 .step = kForceStep * range,
                                 .low = 0.0,
                                 .high = range};
          const Coordinate full{.quantity = &kSpeed,
                                .value = speed,
                                .prior_mean = speed,
                                .prior_sd = kSpeedSd,
                                .step = kSpeedStep,
                                .low = speed - kSpeedReach,
                                .high = speed + kSpeedReach};
          found.push_back(
              effect(place_of(*at.channel),
                     {force, full, gain_ratio_coordinate(), time_constant_coordinate(0.0)},
                     members_cost(outlook)));
        }
    }
  }

  /// What sticks in one row and slips in the next is no smooth misfit.
  [[nodiscard]] int kinked_numbers() const override { return 2; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const Parameter* force = finding.find(kForce);
    return "Dry friction holds " + names.cv(place.cv).tag + " back" +
           (force == nullptr ? ""
                             : ": " + names.in_source(force->value, place) + " of " +
                                   names.source(place).tag + " (" + interval_of(*force) + ")") +
           ". ";
  }
};

}  // namespace

const Cause& coulomb_friction() {
  static const DryFriction cause;
  return cause;
}

}  // namespace mpm::causes
