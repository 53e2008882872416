#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "config/load_model_parts.hpp"
#include "config/yaml_text.hpp"
#include "core/model/eigenvalues.hpp"

namespace mpm::config {
namespace {

// Bounds that keep memory sane and catch seconds mistaken for minutes or samples.
constexpr double kMostDelaySamples = 100000.0;
constexpr std::size_t kMostCoefficients = 200;
constexpr std::size_t kMostSteps = 100000;
constexpr double kUnitCircle = 1.0 + 1e-6;  // on it is an integrator, within rounding

const std::vector<std::string> kPlace = {"cv", "mv", "dv", "input"};
const std::vector<std::string> kContinuous = {"gain", "time_constants", "lead", "dead_time",
                                              "integrating"};
const std::vector<std::string> kDiscrete = {"numerator", "denominator", "delay_samples"};
const std::vector<std::string> kStep = {"step_response"};
const std::vector<std::string> kTanks = {"tanks"};

TransferFunction read_continuous(const Map& map, double sample_time_s) {
  TransferFunction tf;
  if (const Value* gain = map.require("gain")) {
    const std::optional<double> value = gain->number();
    tf.gain = value.value_or(1.0);
    if (value == 0.0) gain->warning("a channel of gain 0 does nothing");
  }
  const Value* constants = map.find("time_constants");
  if (constants != nullptr) tf.time_constants_s = constants->numbers(kPositive);
  if (tf.time_constants_s.size() > kMostCoefficients)
    constants->error("more than " + std::to_string(kMostCoefficients) + " time constants");
  if (const Value* lead = map.find("lead")) tf.lead_s = lead->number().value_or(0.0);
  if (const Value* dead_time = map.find("dead_time")) {
    tf.dead_time_s = dead_time->number(kNotNegative).value_or(0.0);
    if (tf.dead_time_s > kMostDelaySamples * sample_time_s)
      dead_time->error("is longer than " + yaml_text(kMostDelaySamples) + " samples");
  }
  if (const Value* flag = map.find("integrating")) tf.integrating = flag->boolean().value_or(false);
  const bool proper = constants != nullptr ? !constants->items().empty() : tf.integrating;
  if (tf.lead_s != 0.0 && !proper)
    map.find("lead")->error("a channel with a lead needs a time constant");
  return tf;
}

/// Largest absolute value of the roots of sum a[i] z^-i, from the companion matrix.
double largest_pole(const std::vector<double>& a) {
  const auto order = static_cast<Eigen::Index>(a.size()) - 1;
  if (order < 1) return 0.0;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  for (Eigen::Index i = 0; i < order; ++i)
    companion(0, i) = -a[static_cast<std::size_t>(i) + 1] / a[0];
  for (Eigen::Index i = 1; i < order; ++i) companion(i, i - 1) = 1.0;
  if (!companion.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(companion, false);
  return solver.info() == Eigen::Success ? solver.eigenvalues().cwiseAbs().maxCoeff() : 0.0;
}

DiscreteFilter read_discrete(const Map& map) {
  DiscreteFilter filter;
  if (const Value* numerator = map.require("numerator")) {
    filter.numerator = numerator->numbers();
    if (numerator->items().empty()) numerator->error("must not be empty");
    if (filter.numerator.size() > kMostSteps) numerator->error("has too many coefficients");
  }
  filter.denominator = {1.0};
  if (const Value* denominator = map.find("denominator")) {
    filter.denominator = denominator->numbers();
    const bool complete = filter.denominator.size() == denominator->items().size();
    if (denominator->items().empty()) {
      denominator->error("must not be empty");
    } else if (filter.denominator.size() > kMostCoefficients) {
      denominator->error("has more than " + std::to_string(kMostCoefficients) + " coefficients");
    } else if (complete && filter.denominator.front() == 0.0) {
      denominator->error("must not begin with 0");
    } else if (complete) {
      const double pole = largest_pole(filter.denominator);
      if (pole > kUnitCircle)
        denominator->warning("is unstable: a pole at |z| = " + yaml_text(pole));
    }
  }
  if (const Value* delay = map.find("delay_samples"))
    filter.delay_samples = delay->integer({.low = 0, .high = kMostDelaySamples}).value_or(0);
  return filter;
}

StepResponse read_step(const Map& map) {
  StepResponse step;
  if (const Value* values = map.require("step_response")) {
    step.values = values->numbers();
    if (values->items().empty()) values->error("must not be empty");
    if (step.values.size() > kMostSteps) values->error("has too many values");
  }
  return step;
}

/// The first key of the map that is among `keys`.
const Map::Entry* first_of(const Map& map, const std::vector<std::string>& keys) {
  for (const std::string& key : keys)
    if (const Map::Entry* entry = map.entry(key)) return entry;
  return nullptr;
}

void read_dynamics(const Map& map, const ModelSignals& signals, ChannelSpec& channel) {
  const Map::Entry* continuous = first_of(map, kContinuous);
  const Map::Entry* discrete = first_of(map, kDiscrete);
  const Map::Entry* step = first_of(map, kStep);
  const Map::Entry* tanks = first_of(map, kTanks);
  const Map::Entry* chosen = nullptr;
  for (const Map::Entry* form : {continuous, discrete, step, tanks})
    if (form != nullptr) chosen = form;
  if (chosen == nullptr) {
    map.place().error("needs `gain`, `numerator`, `step_response` or `tanks`");
    return;
  }
  for (const Map::Entry* other : {continuous, discrete, step})
    if (other != nullptr && other != chosen)
      other->key_at.error("does not go with `" + chosen->key + "` in one channel");
  if (chosen == tanks) {
    channel.dynamics = read_tanks(tanks->value, signals, channel.cv, channel.input);
  } else if (chosen == step) {
    channel.dynamics = read_step(map);
  } else if (chosen == discrete) {
    channel.dynamics = read_discrete(map);
  } else {
    channel.dynamics = read_continuous(map, signals.sample_time_s);
  }
}

}  // namespace

ChannelPlace read_place(const Map& map, const ModelSignals& signals) {
  const Value* cv = map.require("cv");
  const Value* mv = map.find("mv");
  const Value* dv = map.find("dv");
  if (mv == nullptr && dv == nullptr) map.place().error("`mv` (or `dv`) is missing");
  if (mv != nullptr && dv != nullptr) dv->error("give either `mv` or `dv`, not both");
  const Value* input = mv != nullptr ? mv : dv;
  return {cv != nullptr ? find_tag(*cv, signals.cvs, "cv") : -1,
          input != nullptr ? find_tag(*input, signals.inputs, signals.input_noun) : -1};
}

std::vector<ChannelSpec> read_channels(const Value& list, const ModelSignals& signals) {
  std::vector<std::string> known;
  for (const auto* keys : {&kPlace, &kContinuous, &kDiscrete, &kStep, &kTanks})
    known.insert(known.end(), keys->begin(), keys->end());
  std::vector<ChannelSpec> channels;
  std::map<std::pair<int, int>, int> lines;
  for (const Value& item : list.items()) {
    if (!item.is_map()) {
      item.error("a channel is a map such as {cv: y1, mv: u1, gain: 2}");
      continue;
    }
    const Map map = item.map(known);
    const ChannelPlace place = read_place(map, signals);
    ChannelSpec channel;
    channel.cv = place.cv;
    channel.input = place.input;
    read_dynamics(map, signals, channel);
    if (const Value* block = map.find("input"))
      channel.input_block = read_input_block(*block, signals.inputs, place.input);
    if (!place.known()) continue;
    const auto [first, is_new] = lines.try_emplace({channel.cv, channel.input}, item.line());
    if (!is_new) {
      item.error("a second channel from '" +
                 signals.inputs[static_cast<std::size_t>(channel.input)] + "' to '" +
                 signals.cvs[static_cast<std::size_t>(channel.cv)] + "'; the first is in line " +
                 std::to_string(first->second));
      continue;
    }
    channels.push_back(std::move(channel));
  }
  return channels;
}

}  // namespace mpm::config
