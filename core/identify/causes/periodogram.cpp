#include "core/identify/causes/periodogram.hpp"

#include <algorithm>
#include <cmath>

namespace mpm {

double power_at(const Eigen::Ref<const Eigen::VectorXd>& values, double angle) {
  const double c = 2.0 * std::cos(angle);
  double s1 = 0.0, s2 = 0.0;
  for (const double value : values) {
    const double s0 = value + c * s1 - s2;
    s2 = s1, s1 = s0;
  }
  return s1 * s1 + s2 * s2 - c * s1 * s2;
}

std::vector<int> loudest_cycles(const Eigen::Ref<const Eigen::VectorXd>& values, int fewest,
                                int most, std::size_t count) {
  struct Peak {
    double power;
    int cycles;
  };
  std::vector<Peak> peaks;
  for (int cycles = fewest; cycles < most; ++cycles)
    peaks.push_back(
        {power_at(values, 2.0 * M_PI * cycles / static_cast<double>(values.size())), cycles});
  std::sort(peaks.begin(), peaks.end(),
            [](const Peak& a, const Peak& b) { return a.power > b.power; });
  std::vector<int> loudest;
  for (std::size_t i = 0; i < std::min(count, peaks.size()); ++i)
    loudest.push_back(peaks[i].cycles);
  return loudest;
}

}  // namespace mpm
