#include "core/identify/causes/unnamed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/misfit_slope.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// s.d. of how much of its gain a channel may win or lose on the way.
constexpr double kModulation = 0.15;
/// s.d. of the log of how much slower it may rise than fall.
constexpr double kAsymmetry = 0.3;
/// A gain swings at least so often in the data, and at most once in so many samples.
constexpr int kFewestSwings = 2;
constexpr double kShortestSwing = 60.0;
/// Frequencies fitted for each channel.
constexpr std::size_t kSwings = 2;

/// Last known value where one is missing; mean 0, half the way from the 1st to the 99th percentile
/// 1. Empty where it does not move.
VectorXd normalised(const Eigen::Ref<const VectorXd>& values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  if (sorted.size() < 20) return {};
  std::sort(sorted.begin(), sorted.end());
  const std::size_t margin = sorted.size() / 100;
  const double reach = 0.5 * (sorted[sorted.size() - 1 - margin] - sorted[margin]);
  if (!(reach > 0.0)) return {};
  double mean = 0.0;
  for (const double value : sorted) mean += value / static_cast<double>(sorted.size());
  VectorXd result(values.size());
  double last = mean;
  for (Index k = 0; k < values.size(); ++k) {
    if (std::isfinite(values(k))) last = values(k);
    result(k) = (last - mean) / reach;
  }
  return result;
}

/// One channel and what it gives the CV, on the samples of the problem.
class Channel {
 public:
  Channel(Problem& problem, const ModelSpec& model, const ChannelSpec& spec)
      : problem_(problem), model_(model), spec_(spec) {
    const auto input = problem.recording().inputs.col(spec.input);
    moves_.resize(input.size());
    double last = model.input_origin(spec.input);
    for (Index k = 0; k < input.size(); ++k) {
      if (std::isfinite(input(k))) last = input(k);
      moves_(k) = last - model.input_origin(spec.input);
    }
    response_ = response_to(moves_);
  }

  [[nodiscard]] const VectorXd& response() const { return response_; }
  [[nodiscard]] const ChannelSpec& spec() const { return spec_; }

  [[nodiscard]] VectorXd modulated(const VectorXd& by) const {
    return response_to(moves_.cwiseProduct(by));
  }

  /// What it gives less while it rises and more while it falls, per unit of log time constant.
  [[nodiscard]] VectorXd slower_up() const {
    const double lag = slowest_time_constant_s(spec_, model_.sample_time_s) / model_.sample_time_s;
    const double pole = std::exp(-1.0 / lag);
    VectorXd result = VectorXd::Zero(response_.size());
    for (Index k = 1; k < result.size(); ++k)
      result(k) = pole * result(k - 1) - std::abs(response_(k) - response_(k - 1));
    return result;
  }

 private:
  [[nodiscard]] VectorXd response_to(const VectorXd& moves) const {
    const Recording driven{0.0, model_.sample_time_s, moves, VectorXd::Zero(moves.size()),
                           MatrixXd(moves.size(), 0)};
    Simulator simulator(driven);
    return simulator.cv(alone(spec_, model_.sample_time_s), 0);
  }

  Problem& problem_;
  const ModelSpec& model_;
  const ChannelSpec& spec_;
  VectorXd moves_, response_;
};

class Collector {
 public:
  Collector(Problem& problem, const std::vector<Effect>& accepted, const CvFit& without)
      : problem_(problem), accepted_(accepted), without_(without), model_(problem.model()) {
    for (const Effect& effect : accepted)
      if (effect.onset == 0) apply(effect, problem.surroundings(), model_);
  }

  std::vector<Effect> collect() {
    for (const ChannelSpec& spec : model_.channels) {
      if (spec.cv != without_.cv || spec.input >= problem_.surroundings().model_inputs) continue;
      const Channel channel(problem_, model_, spec);
      if (!channel.response().allFinite()) continue;
      products(channel);
      swings(channel);
      add(channel, "direction", {channel.slower_up()}, kAsymmetry, 1);
    }
    return std::move(found_);
  }

 private:
  void add(const Channel& channel, const char* kind, const std::vector<VectorXd>& columns,
           double sd, std::size_t alternatives) {
    const Subject subject{Cause::kUnnamed, channel.spec().cv, channel.spec().input, -1, kind};
    const auto same = [&](const Effect& effect) { return effect.subject == subject; };
    if (std::any_of(accepted_.begin(), accepted_.end(), same)) return;
    Effect effect;
    effect.subject = subject;
    auto shape = std::make_shared<MatrixXd>(problem_.samples(), static_cast<Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      shape->col(static_cast<Index>(i)) = columns[i];
      effect.coordinates.push_back(
          {"part_" + std::to_string(i + 1), 0.0, 0.0, sd, 0.1 * sd, -1e3, 1e3});
    }
    effect.shape = std::move(shape);
    effect.search_cost = cost_of(alternatives) + cost_of(model_.channels.size());
    found_.push_back(std::move(effect));
  }

  void products(const Channel& channel) {
    const int inputs = problem_.surroundings().model_inputs;
    for (int other = 0; other < inputs; ++other) {
      if (other == channel.spec().input) continue;
      const VectorXd by = normalised(problem_.recording().inputs.col(other));
      if (by.size() > 0)
        add(channel, "product", {channel.modulated(by)}, kModulation,
            static_cast<std::size_t>(inputs));
    }
  }

  /// Where the innovations and the channel's response beat against each other.
  void swings(const Channel& channel) {
    const Index samples = problem_.samples();
    const VectorXd beat =
        misfit_slope(problem_.data(without_.cv), without_).cwiseProduct(channel.response());
    struct Swing {
      double power, frequency;  // per sample
    };
    std::vector<Swing> all;
    const double length = static_cast<double>(samples);
    const auto cycle = [&](double frequency, VectorXd& sine, VectorXd& cosine) {
      sine.resize(samples), cosine.resize(samples);
      for (Index k = 0; k < samples; ++k) {
        const double angle = 2.0 * std::numbers::pi * frequency * static_cast<double>(k);
        sine(k) = std::sin(angle), cosine(k) = std::cos(angle);
      }
    };
    const auto most = static_cast<int>(2.0 * length / kShortestSwing);
    for (int half = 2 * kFewestSwings; half <= most; ++half) {
      const double frequency = 0.5 * half / length;
      const double c = 2.0 * std::cos(2.0 * std::numbers::pi * frequency);
      double s1 = 0.0, s2 = 0.0;  // Goertzel's recursion
      for (const double value : beat) {
        const double s0 = value + c * s1 - s2;
        s2 = s1, s1 = s0;
      }
      all.push_back({s1 * s1 + s2 * s2 - c * s1 * s2, frequency});
    }
    std::sort(all.begin(), all.end(),
              [](const Swing& x, const Swing& y) { return x.power > y.power; });
    VectorXd sine, cosine;
    for (std::size_t i = 0; i < std::min(kSwings, all.size()); ++i) {
      cycle(all[i].frequency, sine, cosine);
      add(channel, "swing",
          {channel.response().cwiseProduct(sine), channel.response().cwiseProduct(cosine)},
          kModulation, all.size());
    }
  }

  Problem& problem_;
  const std::vector<Effect>& accepted_;
  const CvFit& without_;
  ModelSpec model_;
  std::vector<Effect> found_;
};

}  // namespace

std::vector<Effect> unnamed_candidates(Problem& problem, const std::vector<Effect>& accepted,
                                       const CvFit& without) {
  return Collector(problem, accepted, without).collect();
}

}  // namespace mpm
