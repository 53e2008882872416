#include "sim/scenario/materiality.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRelativeCap = 1.0, kDeadTimeCap = 20.0;  // samples
constexpr double kSmallestShare = 1.0 / 128.0;
constexpr int kHalvings = 7;  // of the ratio 128: 4 %

VectorXd weights(const std::vector<double>& given, std::size_t count) {
  VectorXd result = VectorXd::Ones(static_cast<Index>(count));
  for (std::size_t i = 0; i < std::min(count, given.size()); ++i)
    result(static_cast<Index>(i)) = given[i];
  return result;
}

/// Smallest error in [cap / 128, cap] that is too much, or nothing. Takes it for granted that a
/// larger error costs more.
std::optional<double> search(const std::function<bool(double)>& too_much, double cap) {
  if (cap <= 0.0 || !too_much(cap)) return std::nullopt;
  double low = cap * kSmallestShare, high = cap;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (too_much(middle) ? high : low) = middle;
  }
  return high;
}

/// The smaller one of both directions; the second is looked at up to the first only.
ChannelLimit::Value both(const std::function<bool(double)>& up,
                         const std::function<bool(double)>& down, double up_cap, double down_cap) {
  const std::optional<double> first = search(up, up_cap);
  const std::optional<double> second = search(down, std::min(down_cap, first.value_or(kInfinity)));
  if (second) return {*second, false};
  if (first) return {*first, false};
  return {up_cap, true};
}

double dead_time_s(const ModelSpec& model, int cv, int input) {
  for (const ChannelSpec& channel : model.channels) {
    if (channel.cv != cv || channel.input != input) continue;
    if (const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics))
      return transfer->dead_time_s;
    if (const auto* filter = std::get_if<DiscreteFilter>(&channel.dynamics))
      return filter->delay_samples * model.sample_time_s;
    if (const auto* tanks = std::get_if<TankChain>(&channel.dynamics)) return tanks->dead_time_s;
  }
  return 0.0;  // not known: only more of it is looked at
}

/// Two digits that count, never with an exponent.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  std::snprintf(text, sizeof text, "%.9g", std::strtod(text, nullptr));
  return text;
}

}  // namespace

double control_cost(const LoopSetup& setup, const CostRuns& runs, double enough) {
  const config::SimulationSettings& settings = setup.unit.simulation;
  const VectorXd cv_weights = weights(settings.cv_weights, setup.unit.cv.size());
  const VectorXd move_weights = weights(settings.move_weights, setup.unit.mv.size());
  VectorXd last = setup.unit.model.input_origin;
  if (last.size() == 0) last = VectorXd::Zero(setup.unit.model.input_count);
  const VectorXd start = last.head(move_weights.size());
  double cost = 0.0;
  LoopSetup each = setup;
  for (int run = 0; run < runs.seeds; ++run) {
    each.seed = setup.seed + static_cast<std::uint64_t>(run);
    ClosedLoop loop(each);
    last = start;
    for (std::int64_t k = 0; k < runs.samples; ++k) {
      const Frame& frame = loop.step();
      if (!loop.finite()) return kInfinity;
      const VectorXd& moved = frame[SignalKind::kMv].values;
      cost += cv_weights.dot(
          (frame[SignalKind::kSetpoint].values - frame[SignalKind::kCv].values).cwiseAbs2());
      cost += move_weights.dot((moved - last).cwiseAbs2());
      last = moved;
      if (cost > enough) return cost;
    }
  }
  return cost;
}

std::vector<ChannelLimit> materiality_limits(const LoopSetup& setup, double rise,
                                             const CostRuns& runs) {
  const double usual = control_cost(setup, runs);
  if (!(usual > 0.0) || !std::isfinite(usual))
    throw std::invalid_argument(
        "the loop without a mismatch has no finite cost to compare with: give the unit noise or "
        "set-points that move, and a controller that holds it");
  const double limit = usual * (1.0 + rise);
  const ModelSpec& model = setup.unit.model;
  const auto too_much = [&](const ChannelChange& change) {
    LoopSetup changed = setup;
    changed.changes.push_back(change);
    return control_cost(changed, runs, limit) > limit;
  };
  std::vector<ChannelLimit> limits;
  for (int cv = 0; cv < model.cv_count; ++cv) {
    for (int input = 0; input < model.input_count; ++input) {
      if (!has_channel(model, cv, input)) continue;
      const auto gain = [&](double ratio) { return too_much({cv, input, ratio, 1.0, 0.0}); };
      const auto time_constant = [&](double ratio) {
        return too_much({cv, input, 1.0, ratio, 0.0});
      };
      const auto dead_time = [&](double error_s) {
        return too_much({cv, input, 1.0, 1.0, error_s});
      };
      ChannelLimit found;
      found.cv = cv;
      found.input = input;
      found.gain = both([&](double e) { return gain(1.0 + e); },
                        [&](double e) { return gain(1.0 - e); }, kRelativeCap, kRelativeCap);
      found.time_constant = both([&](double e) { return time_constant(1.0 + e); },
                                 [&](double e) { return time_constant(1.0 / (1.0 + e)); },
                                 kRelativeCap, kRelativeCap);
      const double cap_s = kDeadTimeCap * model.sample_time_s;
      found.dead_time =
          both([&](double e) { return dead_time(e); }, [&](double e) { return dead_time(-e); },
               cap_s, std::min(cap_s, dead_time_s(model, cv, input)));
      limits.push_back(found);
    }
  }
  return limits;
}

void print_limits(std::ostream& out, const LoopSetup& setup,
                  const std::vector<ChannelLimit>& limits, double rise, const CostRuns& runs) {
  const config::UnitConfig& unit = setup.unit;
  out << "# Errors of one channel at which the controller's cost (set-point errors and moves by "
         "its\n"
         "# weights) is "
      << number(100.0 * rise) << " % above that of an exact model. Mean of " << runs.seeds
      << " runs of " << runs.samples << " samples with\n# noise, from seed " << setup.seed
      << " on. `>`: no error up to this one costs so much.\n";
  out << "monitor:\n  materiality:\n    channels:             # relative, relative, s\n";
  for (const ChannelLimit& limit : limits) {
    std::string line = "      - {cv: " + unit.cv[static_cast<std::size_t>(limit.cv)].tag +
                       ", mv: " + unit.input_tag(limit.input);
    std::string capped;
    const auto add = [&](const char* key, const ChannelLimit::Value& value) {
      line += std::string(", ") + key + ": " + number(value.error);
      if (value.capped) capped += (capped.empty() ? "   # > " : ", ") + std::string(key);
    };
    add("gain", limit.gain);
    add("time_constant", limit.time_constant);
    add("dead_time", limit.dead_time);
    out << line << '}' << capped << '\n';
  }
}

}  // namespace mpm::sim
