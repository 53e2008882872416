#include "core/model/tank_channel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/model/calibration.hpp"
#include "core/model/zero_order_hold.hpp"

namespace mpm {
namespace {

// Alexander's root of 6 g^3 - 18 g^2 + 9 g - 1 in (1/6, 1/2), and the tableau that follows from it.
constexpr double kGamma = 0.43586652150845899942;
constexpr double kMiddle = 0.5 * (1.0 - kGamma);
constexpr double kFirst = -0.25 * (6.0 * kGamma * kGamma - 16.0 * kGamma + 1.0);
constexpr double kSecond = 0.25 * (6.0 * kGamma * kGamma - 20.0 * kGamma + 5.0);

using calibration::model_rounding::kSame;
using calibration::tanks::kMostSteps;
using calibration::tanks::kNearlyEmpty;
using calibration::tanks::kParts;
using calibration::tanks::kStepsPerTimeConstant;

void check(const TankChain& tanks, double input_origin, double output_origin,
           double sample_time_s) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!positive(sample_time_s)) throw std::invalid_argument("sample time must be positive");
  if (tanks.time_constants_s.empty() ||
      !std::all_of(tanks.time_constants_s.begin(), tanks.time_constants_s.end(), positive))
    throw std::invalid_argument("tanks: one positive time constant per tank expected");
  if (!std::isfinite(tanks.empty_input) || tanks.empty_input == input_origin)
    throw std::invalid_argument("tanks: the input has no flow at the operating point");
  if (!std::isfinite(tanks.empty_output) || tanks.empty_output == output_origin)
    throw std::invalid_argument("tanks: the last tank is empty at the operating point");
  if (!tanks.overflow.empty() && tanks.overflow.size() != tanks.time_constants_s.size())
    throw std::invalid_argument("tanks: one overflow level per tank expected");
  if (!std::all_of(tanks.overflow.begin(), tanks.overflow.end(),
                   [](double level) { return level > 1.0; }))
    throw std::invalid_argument("tanks: overflow levels must be above 1, the operating point");
  if (!(tanks.spill >= 0.0 && tanks.spill <= 1.0))
    throw std::invalid_argument("tanks: spill must be in 0 .. 1");
  if (!(tanks.dead_time_s >= 0.0 &&
        tanks.dead_time_s / sample_time_s < calibration::kLongestDeadTime))
    throw std::invalid_argument("dead time must be in 0 .. 1e6 samples");
}

}  // namespace

double Tank::step(double level, double step_s, StageFlow& flow) const {
  const double rate = 2.0 * step_s / time_constant_s;
  const double c = rate * kGamma;
  const double known[3][2] = {{0.0, 0.0}, {kMiddle, 0.0}, {kFirst, kSecond}};
  double slope[2] = {0.0, 0.0};
  double h = level;
  for (std::size_t i = 0; i < 3; ++i) {
    const double base = level + rate * (known[i][0] * slope[0] + known[i][1] * slope[1]);
    // h = base + c (flow - sqrt(h)) as a quadratic in the root, without cancellation.
    const double total = base + c * flow[i];
    const double root = total > 0.0 ? 2.0 * total / (c + std::sqrt(c * c + 4.0 * total)) : 0.0;
    h = root * root;
    double out = root;
    if (h > overflow) {
      h = overflow;
      const double over = (total - overflow) / c - std::sqrt(overflow);
      out = std::sqrt(overflow) + spill * over;
    }
    if (i < 2) slope[i] = (h - base) / c;
    flow[i] = out;
  }
  return h;
}

double Tank::rest(double& flow) const {
  const double level = std::min(flow * flow, overflow);
  const double out = std::min(flow, std::sqrt(overflow));
  flow = out + spill * (flow - out);
  return level;
}

double TankChannel::inflow(double deviation) const {
  return std::max(0.0, 1.0 + deviation / input_span);  // a closed valve draws nothing back
}

void TankChannel::pass(double inflow, const Piece& piece, double* levels) const {
  const double whole_s = piece.duration_s / piece.steps;
  for (int step = 0; step < piece.steps; ++step) {
    const int parts = *std::min_element(levels, levels + tanks.size()) < kNearlyEmpty ? kParts : 1;
    for (int part = 0; part < parts; ++part) {
      Tank::StageFlow flow;
      flow.fill(inflow);
      for (std::size_t n = 0; n < tanks.size(); ++n)
        levels[n] = tanks[n].step(levels[n], whole_s / parts, flow);
    }
  }
}

void TankChannel::step(const InputHistory& inputs, Eigen::VectorXd& states) const {
  const double* input = inputs.newest(source);
  double* levels = states.data() + first_state;
  if (older.steps > 0) pass(inflow(input[-delay - 1]), older, levels);
  pass(inflow(input[-delay]), newer, levels);
}

void TankChannel::rest(const InputHistory& inputs, Eigen::VectorXd& states) const {
  double flow = inflow(*inputs.newest(source));
  for (std::size_t n = 0; n < tanks.size(); ++n)
    states(first_state + static_cast<Eigen::Index>(n)) = tanks[n].rest(flow);
}

DescribedTanks make_tank_channel(int cv, int source, const TankChain& tanks, double input_origin,
                                 double output_origin, double sample_time_s,
                                 Eigen::Index first_state) {
  check(tanks, input_origin, output_origin, sample_time_s);
  const double fastest_s =
      *std::min_element(tanks.time_constants_s.begin(), tanks.time_constants_s.end());
  const auto piece = [&](double duration_s) {
    const double steps = std::ceil(kStepsPerTimeConstant * duration_s / fastest_s - kSame);
    return TankChannel::Piece{
        duration_s, duration_s > 0.0 ? static_cast<int>(std::clamp(steps, 1.0, kMostSteps)) : 0};
  };
  const SampledDelay delay = sampled_delay(tanks.dead_time_s, sample_time_s);
  TankChannel made{cv,
                   source,
                   {},
                   input_origin - tanks.empty_input,
                   output_origin - tanks.empty_output,
                   delay.whole,
                   piece(delay.fraction * sample_time_s),
                   piece((1.0 - delay.fraction) * sample_time_s),
                   first_state};
  ChannelFacts facts;
  for (std::size_t n = 0; n < tanks.time_constants_s.size(); ++n) {
    made.tanks.push_back(
        {tanks.time_constants_s[n],
         tanks.overflow.empty() ? std::numeric_limits<double>::infinity() : tanks.overflow[n],
         tanks.spill});
    facts.slowest = std::max(facts.slowest, tanks.time_constants_s[n] / sample_time_s);
  }
  facts.gain = linearised(tanks, input_origin, output_origin).gain;
  facts.dead_time = tanks.dead_time_s / sample_time_s;
  facts.order = static_cast<Eigen::Index>(tanks.time_constants_s.size());
  return {std::move(made), facts};
}

TransferFunction linearised(const TankChain& tanks, double input_origin, double output_origin) {
  TransferFunction transfer;
  transfer.gain = 2.0 * (output_origin - tanks.empty_output) / (input_origin - tanks.empty_input);
  transfer.time_constants_s = tanks.time_constants_s;
  transfer.dead_time_s = tanks.dead_time_s;
  return transfer;
}

}  // namespace mpm
