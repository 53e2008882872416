#pragma once

#include <cstdint>

/// Twin of tests/oracles/counter_noise.py: same numbers, bit for bit.
namespace mpm::test {

inline double uniform(std::uint64_t stream, std::int64_t index) {
  std::uint64_t z =
      stream * 0x9E3779B97F4A7C15ULL + static_cast<std::uint64_t>(index) * 0xD1342543DE82EF95ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z = z ^ (z >> 31);
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

inline double coloured(std::uint64_t stream, std::int64_t index) {
  const std::int64_t at = index + 16;
  double total = uniform(stream, at);
  total = total + 0.75 * uniform(stream, at - 1);
  total = total + 0.5 * uniform(stream, at - 2);
  total = total + 0.375 * uniform(stream, at - 3);
  total = total + 0.25 * uniform(stream, at - 4);
  return total;
}

}  // namespace mpm::test
