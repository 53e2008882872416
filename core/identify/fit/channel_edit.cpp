#include "core/identify/fit/channel_edit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <type_traits>

#include "core/identify/fit/calibration.hpp"
#include "core/model/eigenvalues.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

constexpr double kWholeSample = 1e-9;

std::vector<std::complex<double>> poles_of(const std::vector<double>& denominator) {
  const auto order = static_cast<Eigen::Index>(denominator.size()) - 1;
  if (order < 1) return {};
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  for (Eigen::Index i = 0; i < order; ++i)
    companion(0, i) = -denominator[static_cast<std::size_t>(i) + 1] / denominator[0];
  for (Eigen::Index i = 1; i < order; ++i) companion(i, i - 1) = 1.0;
  const Eigen::VectorXcd roots = companion.eigenvalues();
  return {roots.data(), roots.data() + roots.size()};
}

std::vector<double> polynomial_of(const std::vector<std::complex<double>>& roots) {
  std::vector<std::complex<double>> coefficients = {1.0};
  for (const std::complex<double>& root : roots) {
    coefficients.emplace_back(0.0);
    for (std::size_t i = coefficients.size() - 1; i > 0; --i)
      coefficients[i] -= root * coefficients[i - 1];
  }
  std::vector<double> real;
  real.reserve(coefficients.size());
  for (const std::complex<double>& value : coefficients) real.push_back(value.real());
  return real;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

void edit(TransferFunction& transfer, const ChannelError& error, double) {
  transfer.gain *= error.gain_ratio;
  for (double& time_constant_s : transfer.time_constants_s)
    time_constant_s *= error.time_constant_ratio;
  transfer.lead_s *= error.time_constant_ratio;
  transfer.dead_time_s = std::max(0.0, transfer.dead_time_s + error.dead_time_error_s);
}

void edit(TankChain& tanks, const ChannelError& error, double) {
  // The gain of tanks is set by their levels: the empty ones move.
  for (double& time_constant_s : tanks.time_constants_s)
    time_constant_s *= error.time_constant_ratio;
  tanks.dead_time_s = std::max(0.0, tanks.dead_time_s + error.dead_time_error_s);
}

/// By parts of a sample too, between whose responses the response lies on a straight line: a fit
/// that could only go by whole samples would see no slope.
void delay(DiscreteFilter& filter, double samples) {
  const double whole = std::floor(std::max(0.0, filter.delay_samples + samples) + kWholeSample);
  const double part = std::max(0.0, filter.delay_samples + samples) - whole;
  filter.delay_samples = static_cast<int>(whole);
  if (part < kWholeSample) return;
  std::vector<double>& numerator = filter.numerator;
  numerator.push_back(0.0);
  for (std::size_t i = numerator.size() - 1; i > 0; --i)
    numerator[i] = (1.0 - part) * numerator[i] + part * numerator[i - 1];
  numerator[0] *= 1.0 - part;
}

void edit(DiscreteFilter& filter, const ChannelError& error, double sample_time_s) {
  if (error.dead_time_error_s != 0.0) delay(filter, error.dead_time_error_s / sample_time_s);
  double factor = error.gain_ratio;
  if (error.time_constant_ratio != 1.0 || error.damping_ratio != 1.0) {
    std::vector<std::complex<double>> poles = poles_of(filter.denominator);
    for (std::complex<double>& pole : poles)
      if (std::abs(pole) > 0.0) {
        std::complex<double> rate = std::log(pole) / error.time_constant_ratio;
        if (pole.imag() != 0.0) rate.real(rate.real() * error.damping_ratio);
        pole = std::exp(rate);
      }
    std::vector<double> denominator = polynomial_of(poles);
    for (double& value : denominator) value *= filter.denominator[0];
    const double before = sum(filter.denominator);
    if (before != 0.0) factor *= sum(denominator) / before;
    filter.denominator = std::move(denominator);
  }
  for (double& value : filter.numerator) value *= factor;
}

void edit(StepResponse& response, const ChannelError& error, double sample_time_s) {
  const std::vector<double> values = response.values;
  const auto count = static_cast<double>(values.size() - 1);
  std::size_t begin = 0;
  while (begin + 1 < values.size() && values[begin + 1] == 0.0) ++begin;
  const auto dead = static_cast<double>(begin);
  const double shift = std::max(-dead, error.dead_time_error_s / sample_time_s);
  const double ratio = error.time_constant_ratio;
  response.values.clear();
  const auto length = static_cast<std::size_t>(std::ceil(dead + shift + (count - dead) * ratio));
  for (std::size_t i = 0; i <= length; ++i) {
    const double at =
        std::clamp(dead + (static_cast<double>(i) - dead - shift) / ratio, 0.0, count);
    const auto left = static_cast<std::size_t>(at);
    const std::size_t right = std::min(left + 1, values.size() - 1);
    const double value =
        values[left] + (at - static_cast<double>(left)) * (values[right] - values[left]);
    response.values.push_back(error.gain_ratio * value);
  }
}

}  // namespace

ModelSpec alone(const ChannelSpec& channel, double sample_time_s) {
  ModelSpec model;
  model.sample_time_s = sample_time_s;
  model.input_count = model.cv_count = 1;
  model.channels = {channel};
  model.channels[0].cv = model.channels[0].input = 0;
  model.channels[0].input_block.reset();
  model.input_blocks.resize(1);
  model.output_blocks.resize(1);
  model.input_origin = model.output_origin = Eigen::VectorXd::Zero(1);
  return model;
}

ChannelSpec edited(const ChannelSpec& channel, const ChannelError& error, double sample_time_s) {
  ChannelSpec result = channel;
  std::visit([&](auto& dynamics) { edit(dynamics, error, sample_time_s); }, result.dynamics);
  return result;
}

bool rings(const ChannelSpec& channel) {
  const auto* filter = std::get_if<DiscreteFilter>(&channel.dynamics);
  if (filter == nullptr) return false;
  const std::vector<std::complex<double>> poles = poles_of(filter->denominator);
  return std::any_of(poles.begin(), poles.end(),
                     [](const std::complex<double>& pole) { return pole.imag() != 0.0; });
}

double removable_dead_time_s(const ChannelSpec& channel, double sample_time_s) {
  if (const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics))
    return transfer->dead_time_s;
  if (const auto* filter = std::get_if<DiscreteFilter>(&channel.dynamics))
    return filter->delay_samples * sample_time_s;
  if (const auto* tanks = std::get_if<TankChain>(&channel.dynamics)) return tanks->dead_time_s;
  const std::vector<double>& values = std::get<StepResponse>(channel.dynamics).values;
  std::size_t begin = 0;
  while (begin + 1 < values.size() && values[begin + 1] == 0.0) ++begin;
  return static_cast<double>(begin) * sample_time_s;
}

double slowest_time_constant_s(const ChannelSpec& channel, double sample_time_s) {
  if (const auto* tanks = std::get_if<TankChain>(&channel.dynamics)) {
    double slowest = sample_time_s;
    for (const double value : tanks->time_constants_s) slowest = std::max(slowest, value);
    return slowest;
  }
  return LinearModel(alone(channel, sample_time_s)).slowest_time_constant_samples() * sample_time_s;
}

double slowest_of_cv_s(const ModelSpec& model, int cv, double least_samples) {
  double slowest = least_samples * model.sample_time_s;
  for (const ChannelSpec& channel : model.channels)
    if (channel.cv == cv)
      slowest = std::max(slowest, slowest_time_constant_s(channel, model.sample_time_s));
  return slowest;
}

namespace {

/// A channel that integrates, as its pulse response has it: z^-1 N(z) / (1 - z^-1), N the moves of
/// the pulse response until it is its slope for good.
DiscreteFilter integrator_of(const Eigen::VectorXd& pulse) {
  const double slope = pulse(pulse.size() - 1), size = pulse.cwiseAbs().maxCoeff();
  Eigen::Index settled = pulse.size() - 1;
  while (settled > 1 && std::abs(pulse(settled - 1) - slope) <= kSettledShare * size) --settled;
  DiscreteFilter filter{{}, {1.0, -1.0}, 0};
  for (Eigen::Index k = 1; k <= settled; ++k)
    filter.numerator.push_back((k < settled ? pulse(k) : slope) - pulse(k - 1));
  return filter;
}

}  // namespace

ModelSpec in_channels(const ModelSpec& model) {
  if (!model.state_space) return model;
  ModelSpec result = model;
  result.state_space.reset();
  const LinearModel simulator(model);
  const int length = simulator.settling_samples(kSettledShare, kLongestResponse) + 2;
  const auto integrating = simulator.integrating();
  for (int cv = 0; cv < model.cv_count; ++cv) {
    for (int input = 0; input < model.input_count; ++input) {
      const Eigen::VectorXd pulse =
          simulator.impulse_response(cv, input, integrating(cv, input) ? kLongestResponse : length);
      if (pulse.isZero(0.0)) continue;
      if (integrating(cv, input)) {
        result.channels.push_back({cv, input, integrator_of(pulse), {}});
        continue;
      }
      StepResponse response;
      double level = 0.0;
      for (const double value : pulse) response.values.push_back(level += value);
      result.channels.push_back({cv, input, response, {}});
    }
  }
  return result;
}

}  // namespace mpm
