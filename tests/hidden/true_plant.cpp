#include "tests/hidden/true_plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <variant>

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// State of a lag of unit gain after `time` under a constant input.
double relaxed(double state, double input, double time, double time_constant) {
  return input + (state - input) * std::exp(-time / time_constant);
}

/// Two unit lags in series after `time` under a constant input, exactly.
void relax(double& first, double& second, double input, double time, double one, double other) {
  const double gap = first - input;
  const double fast = std::exp(-time / one);
  const double slow = std::exp(-time / other);
  // second - input decays by its own lag and is fed by the first's gap.
  const double fed =
      std::abs(one - other) > 1e-9 * one ? one / (one - other) * (fast - slow) : time / one * fast;
  second = input + (second - input) * slow + gap * fed;
  first = input + gap * fast;
}

}  // namespace

TruePlant::TruePlant(TruePlantSpec spec) : spec_(std::move(spec)) {
  for (const Element& element : spec_.input_elements) elements_.emplace_back(element);
  for (const TrueChannel& channel : spec_.channels)
    running_.push_back({RunningElement(channel.element),
                        std::vector<double>(static_cast<std::size_t>(channel.dead_time) + 2, 0.0)});
}

void TruePlant::rest_at(const VectorXd& aux) {
  for (std::size_t i = 0; i < running_.size(); ++i) {
    const TrueChannel& channel = spec_.channels[i];
    if (channel.input < spec_.input_count) continue;
    const double level =
        channel.gain * (aux(channel.input - spec_.input_count) - spec_.input_origin(channel.input));
    running_[i].first = running_[i].second = level;
    std::fill(running_[i].past.begin(), running_[i].past.end(), level);
  }
}

VectorXd TruePlant::measured(const VectorXd& noise) const {
  VectorXd y = spec_.output_origin + noise;
  if (k_ < spec_.disturbance.rows()) y += spec_.disturbance.row(k_).transpose();
  for (std::size_t i = 0; i < running_.size(); ++i) {
    const TrueChannel& channel = spec_.channels[i];
    if (!channel.switched_at_input && (k_ < channel.from || k_ >= channel.until)) continue;
    y(channel.cv) += channel.second_time_constant > 0.0 ? running_[i].second : running_[i].first;
  }
  for (std::size_t cv = 0; cv < spec_.clipping.size(); ++cv)
    if (const auto& limits = spec_.clipping[cv]) {
      const auto j = static_cast<Index>(cv);
      y(j) = std::clamp(y(j), limits->low, limits->high);
    }
  return y;
}

void TruePlant::advance(const VectorXd& inputs, const VectorXd& aux) {
  VectorXd deviation(spec_.input_count + spec_.aux_count);
  deviation << inputs, aux;
  deviation -= spec_.input_origin;
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    double& value = deviation(static_cast<Index>(i));
    value = elements_[i].next(value);
  }
  for (std::size_t i = 0; i < running_.size(); ++i)
    advance(spec_.channels[i], running_[i], deviation);
  ++k_;
}

void TruePlant::advance(const TrueChannel& channel, Running& running, const VectorXd& deviation) {
  double gain = channel.gain;
  if (channel.modulator >= 0) gain *= 1.0 + channel.modulation * deviation(channel.modulator);
  if (channel.swing != 0.0)
    gain *= 1.0 + channel.swing * std::sin(2.0 * std::numbers::pi * k_ / channel.swing_period);
  if (channel.switched_at_input && (k_ < channel.from || k_ >= channel.until)) gain = 0.0;
  const double entering = gain * running.element.next(deviation(channel.input));
  std::rotate(running.past.begin(), running.past.end() - 1, running.past.end());
  running.past.front() = entering;

  const auto whole = static_cast<std::size_t>(channel.dead_time);
  const double fraction = channel.dead_time - static_cast<double>(whole);
  for (const auto& [input, time] : {std::pair(running.past[whole + 1], fraction),
                                    std::pair(running.past[whole], 1.0 - fraction)}) {
    if (time == 0.0) continue;
    double lag = channel.time_constant;
    if (channel.asymmetry != 0.0)
      lag *= input > running.first ? 1.0 + channel.asymmetry : 1.0 / (1.0 + channel.asymmetry);
    if (channel.second_time_constant > 0.0)
      relax(running.first, running.second, input, time, lag, channel.second_time_constant);
    else
      running.first = relaxed(running.first, input, time, lag);
  }
}

TruePlantSpec plant_like(const ModelSpec& model) {
  TruePlantSpec plant;
  plant.input_count = model.input_count;
  plant.cv_count = model.cv_count;
  const auto or_zero = [](const VectorXd& origin, int size) {
    return origin.size() == size ? origin : VectorXd::Zero(size);
  };
  plant.input_origin = or_zero(model.input_origin, model.input_count);
  plant.output_origin = or_zero(model.output_origin, model.cv_count);
  plant.input_elements.resize(static_cast<std::size_t>(model.input_count));
  plant.clipping.resize(static_cast<std::size_t>(model.cv_count));
  for (const ChannelSpec& channel : model.channels) {
    const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
    if (transfer == nullptr || transfer->integrating || transfer->lead_s != 0.0 ||
        transfer->time_constants_s.size() != 1)
      throw std::invalid_argument("hidden plants are drawn from gain, one lag and dead time only");
    TrueChannel copy;
    copy.cv = channel.cv;
    copy.input = channel.input;
    copy.gain = transfer->gain;
    copy.time_constant = transfer->time_constants_s[0] / model.sample_time_s;
    copy.dead_time = transfer->dead_time_s / model.sample_time_s;
    plant.channels.push_back(copy);
  }
  return plant;
}

MatrixXd simulate(const TruePlantSpec& spec, const MatrixXd& inputs, const MatrixXd& aux) {
  TruePlant plant(spec);
  plant.rest_at(aux.row(0));
  const VectorXd silence = VectorXd::Zero(spec.cv_count);
  MatrixXd result(inputs.rows(), spec.cv_count);
  for (Index k = 0; k < inputs.rows(); ++k) {
    result.row(k) = plant.measured(silence);
    plant.advance(inputs.row(k), aux.row(k));
  }
  return result;
}

MatrixXd steady_gain(const TruePlantSpec& spec) {
  MatrixXd gain = MatrixXd::Zero(spec.cv_count, spec.input_count);
  for (const TrueChannel& channel : spec.channels)
    if (channel.input < spec.input_count && channel.until == std::numeric_limits<int>::max())
      gain(channel.cv, channel.input) += channel.gain;
  return gain;
}

}  // namespace mpm::hidden
