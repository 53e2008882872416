#pragma once

#include <random>
#include <vector>

namespace mpm::test {

/// Near enough to normal with mean 0 and variance 1: sums of twelve uniform numbers.
inline std::vector<double> white(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> values(count);
  for (double& value : values) {
    value = -6.0;
    for (int i = 0; i < 12; ++i) value += static_cast<double>(random()) / 4294967296.0;
  }
  return values;
}

}  // namespace mpm::test
