#include "core/identification/damped_pair.hpp"

#include <cmath>

#include "core/model/zero_order_hold.hpp"

namespace mpm {

double step_response(const DampedPair& pair, double since) {
  if (!(since > 0.0)) return 0.0;
  const double turn = std::sqrt(1.0 - pair.damping * pair.damping), t = since / pair.time;
  return 1.0 - std::exp(-pair.damping * t) *
                   (std::cos(turn * t) + pair.damping / turn * std::sin(turn * t));
}

DiscreteFilter sampled(const DampedPair& pair, double gain, double dead_time, double sample_time) {
  const SampledDelay delay = sampled_delay(dead_time, sample_time);
  const auto after = [&](int samples) {
    return gain * step_response(pair, (samples - delay.fraction) * sample_time);
  };
  const double first = after(1), second = after(2) - first, third = after(3) - after(2);
  const double decay = std::exp(-pair.damping * sample_time / pair.time);
  const double turn = std::sqrt(1.0 - pair.damping * pair.damping) * sample_time / pair.time;
  const double a1 = -2.0 * decay * std::cos(turn), a2 = decay * decay;
  DiscreteFilter filter;
  filter.numerator = {first, second + a1 * first};
  if (delay.fraction > 0.0) filter.numerator.push_back(third + a1 * second + a2 * first);
  filter.denominator = {1.0, a1, a2};
  filter.delay_samples = delay.whole;
  return filter;
}

}  // namespace mpm
