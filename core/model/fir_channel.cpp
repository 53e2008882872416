#include "core/model/fir_channel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/model/calibration.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// The values from index 0 (which is 0) to the last one that differs from its predecessor.
std::vector<double> essential_steps(const StepResponse& response) {
  if (response.values.empty()) throw std::invalid_argument("step response: values expected");
  for (const double value : response.values)
    if (!std::isfinite(value)) throw std::invalid_argument("step response: values must be finite");
  std::vector<double> steps = response.values;
  if (steps.size() == 1) steps.push_back(steps[0]);
  while (steps.size() > 2 && steps.back() == steps[steps.size() - 2]) steps.pop_back();
  steps[0] = 0.0;
  return steps;
}

ChannelFacts facts_of(const std::vector<double>& steps) {
  ChannelFacts result;
  result.gain = steps.back();
  result.order = 0;
  const double size =
      std::abs(*std::max_element(steps.begin(), steps.end(), [](double left, double right) {
        return std::abs(left) < std::abs(right);
      }));
  std::size_t first = 1;
  while (first + 1 < steps.size() && std::abs(steps[first]) <= calibration::kNotBegun * size)
    ++first;
  result.dead_time = static_cast<double>(first - 1);
  std::size_t last_far = first - 1;
  for (std::size_t i = first; i < steps.size(); ++i)
    if (std::abs(steps[i] - result.gain) > std::exp(-1.0) * std::abs(result.gain)) last_far = i;
  result.slowest = std::max(1.0, static_cast<double>(last_far + 1 - first));
  return result;
}

}  // namespace

DescribedFir make_fir_channel(int cv, int source, const StepResponse& response) {
  // weights h(1) .. h(L-1), newest input last. A direct part values[0] acts on the input just
  // before the sampling instant, as everywhere: it is within values[1].
  const std::vector<double> steps = essential_steps(response);
  const auto length = static_cast<Index>(steps.size()) - 1;
  FirChannel fir{cv, source, Eigen::VectorXd::Zero(length)};
  for (Index lag = 1; lag <= length; ++lag)
    fir.weights(length - lag) =
        steps[static_cast<std::size_t>(lag)] - steps[static_cast<std::size_t>(lag - 1)];
  return {std::move(fir), facts_of(steps)};
}

}  // namespace mpm
