#include "sim/signals/random_stream.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace mpm::sim {
namespace {

/// One step of SplitMix64 (Steele, Lea and Flood 2014): neighbouring seeds become unrelated.
std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint64_t index)
    : engine_(mix(mix(mix(seed) ^ static_cast<std::uint64_t>(purpose)) ^ index)) {}

double RandomStream::uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double RandomStream::normal() {
  if (spare_normal_) return *std::exchange(spare_normal_, std::nullopt);
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  return radius * std::cos(angle);
}

double RandomStream::student_t(double freedom) {
  const double radius = std::sqrt(freedom * (std::pow(1.0 - uniform(), -2.0 / freedom) - 1.0));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

std::uint64_t RandomStream::below(std::uint64_t count) {
  // Rejects the few values that would make the remainder uneven.
  const std::uint64_t limit = engine_.max() - engine_.max() % count;
  std::uint64_t value = engine_();
  while (value >= limit) value = engine_();
  return value % count;
}

}  // namespace mpm::sim
