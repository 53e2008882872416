#include "sim/scenario/random_change.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/mpc/linear_gain.hpp"
#include "sim/scenario/stability.hpp"

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kEigenvalueMargin = 0.2;
constexpr double kSettledShare = 0.05;

VectorXd trial_amplitudes(const config::UnitConfig& unit) {
  VectorXd amplitudes = VectorXd::Ones(static_cast<Index>(unit.cv.size()));
  for (std::size_t i = 0; i < unit.simulation.setpoints.size(); ++i)
    if (unit.simulation.setpoints[i].amplitude > 0.0)
      amplitudes(static_cast<Index>(i)) = unit.simulation.setpoints[i].amplitude;
  return amplitudes;
}

/// Largest control error at the end of the trial, each in shares of its CV's step.
double rest_error(const LoopSetup& setup, const std::vector<ChannelChange>& changes) {
  const config::UnitConfig& unit = setup.unit;
  Plant plant(unit.model, changes);
  Mpc controller(setup.controller_model, static_cast<int>(unit.mv.size()),
                 limited_settings(unit, setup.scenario), feedback_share(setup.scenario));
  const VectorXd amplitudes = trial_amplitudes(unit);
  VectorXd origin = unit.model.output_origin;
  if (origin.size() == 0) origin = VectorXd::Zero(unit.model.cv_count);
  VectorXd setpoint = origin;
  VectorXd input = unit.model.input_origin;
  if (input.size() == 0) input = VectorXd::Zero(unit.model.input_count);
  const VectorXd disturbance = input.tail(static_cast<Index>(unit.dv.size()));

  constexpr int kLongestSegment = 2000;
  const int segment =
      std::max(unit.simulation.prediction_horizon,
               LinearModel(unit.model).settling_samples(kSettledShare, kLongestSegment));
  const int rest = 6 * segment;
  const int moving = segment * unit.model.cv_count;
  double largest = 0.0;
  for (int k = 0; k < moving + rest; ++k) {
    const int cv = k / segment;
    if (k % segment == 0 && cv < unit.model.cv_count)
      setpoint(cv) = origin(cv) + (cv % 2 == 0 ? 1.0 : -1.0) * amplitudes(cv);
    const VectorXd error = (setpoint - plant.output()).cwiseAbs().cwiseQuotient(amplitudes);
    if (!error.allFinite()) return error.norm();
    if (k >= moving + 3 * rest / 4) largest = std::max(largest, error.maxCoeff());
    input.head(static_cast<Index>(unit.mv.size())) =
        controller.control(plant.output(), setpoint, disturbance);
    plant.advance(input);
  }
  return largest;
}

/// Shuffles by the stream, the same on every platform (Fisher and Yates).
template <class Item>
void shuffle(std::vector<Item>& items, RandomStream& stream) {
  for (std::size_t left = items.size(); left > 1; --left)
    std::swap(items[left - 1], items[stream.below(left)]);
}

std::vector<ChannelChange> candidates(const LoopSetup& setup, const config::RandomDraw& draw) {
  std::vector<ChannelChange> result;
  const ModelSpec& model = setup.unit.model;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    for (int mv = 0; mv < static_cast<int>(setup.unit.mv.size()); ++mv) {
      if (!has_channel(model, cv, mv)) continue;
      const ChannelChange none{cv, mv, 1.0, 1.0, 0.0, draw.from_s, draw.until_s};
      for (const double ratio : draw.gain_ratios) {
        result.push_back(none);
        result.back().gain_ratio = ratio;
      }
      for (const double ratio : draw.time_constant_ratios) {
        result.push_back(none);
        result.back().time_constant_ratio = ratio;
      }
      for (const double error_s : draw.dead_time_errors_s) {
        result.push_back(none);
        result.back().dead_time_error_s = error_s;
      }
    }
  }
  return result;
}

/// All changes in force at once and from the start.
bool bearable(const LoopSetup& setup, std::vector<ChannelChange> changes) {
  for (ChannelChange& change : changes) {
    change.from_s = 0.0;
    change.until_s = config::kForEver;
  }
  try {
    const ModelSpec plant = changed_model(setup.unit.model, changes);
    const int mvs = static_cast<int>(setup.unit.mv.size());
    const GainAgreement gains =
        compare_gains(operating_gain(setup.controller_model, mvs), operating_gain(plant, mvs),
                      setup.unit.simulation.cv_weights);
    if (!gains.stabilisable(kEigenvalueMargin)) return false;
  } catch (const std::invalid_argument&) {
    return false;  // such as a negative dead time
  }
  LoopSetup trial = setup;
  trial.changes = std::move(changes);
  return settles(trial);
}

}  // namespace

bool settles(const LoopSetup& setup) {
  const double error = rest_error(setup, setup.changes);
  if (error <= kSettledShare) return true;
  // Set-points that cannot be reached (limits, fewer MVs than CVs) leave an error in any case.
  LoopSetup exact = setup;
  exact.controller_model = setup.unit.model;
  return error <= 2.0 * rest_error(exact, {});
}

std::optional<std::vector<ChannelChange>> draw_changes(const LoopSetup& setup) {
  std::vector<ChannelChange> drawn;
  if (!setup.scenario.draw) return drawn;
  RandomStream stream(setup.seed, StreamPurpose::kHiddenChange, 0);
  std::vector<ChannelChange> open = candidates(setup, *setup.scenario.draw);
  shuffle(open, stream);
  std::vector<ChannelChange> all = setup.changes;
  for (const ChannelChange& candidate : open) {
    if (static_cast<int>(drawn.size()) == setup.scenario.draw->count) break;
    const bool used = std::any_of(drawn.begin(), drawn.end(), [&](const ChannelChange& other) {
      return other.cv == candidate.cv && other.input == candidate.input;
    });
    if (used) continue;
    all.push_back(candidate);
    if (bearable(setup, all))
      drawn.push_back(candidate);
    else
      all.pop_back();
  }
  if (static_cast<int>(drawn.size()) < setup.scenario.draw->count) return std::nullopt;
  return drawn;
}

}  // namespace mpm::sim
