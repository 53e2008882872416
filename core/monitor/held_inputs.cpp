#include "core/monitor/held_inputs.hpp"

#include <cmath>
#include <limits>

#include "core/monitor/calibration.hpp"

namespace mpm {

using calibration::held_inputs::kVarianceOfUniform;

HeldInputs::HeldInputs(const LinearModel& model)
    : gains_(model.steady_gain()), time_constants_(gains_.rows(), gains_.cols()) {
  const auto integrating = model.integrating();
  for (int j = 0; j < gains_.rows(); ++j)
    for (int i = 0; i < gains_.cols(); ++i) {
      if (integrating(j, i)) gains_(j, i) = std::numeric_limits<double>::infinity();
      time_constants_(j, i) = model.time_constant_samples(j, i);
    }
}

int HeldInputs::heaviest(int cv, const Screen& screen, double noise, double share) const {
  int heaviest = -1;
  double most = share * noise;
  for (int i = 0; noise > 0.0 && i < static_cast<int>(gains_.cols()); ++i) {
    const Compression& input = screen.input_compression(i);
    if (input.kind() != Compression::Kind::kHeld || gains_(cv, i) == 0.0) continue;
    const double passed = std::tanh(input.held_for() / (2.0 * time_constants_(cv, i)));
    const double off = std::abs(gains_(cv, i)) * input.smallest_change() *
                       std::sqrt(input.held_share() * passed * kVarianceOfUniform);
    if (off <= most) continue;
    most = off;
    heaviest = i;
  }
  return heaviest;
}

}  // namespace mpm
