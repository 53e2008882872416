#pragma once

#include <cstdint>
#include <optional>
#include <random>

namespace mpm::sim {

/// What a stream of random numbers is for. Each signal has a stream of its own, so that a change in
/// one (another noise level, one set-point more) does not shift the numbers of another.
enum class StreamPurpose : std::uint64_t {
  kNoise = 1,
  kDisturbance,
  kSetpoint,
  kHiddenChange,
  kTails,
  kDrift,
  kSensorNoise,
  kBadData,
  kAux,
  kTest,
  kProcess,
};

/// Random numbers of one purpose and index under one seed. The same on every platform: the standard
/// fixes the engine but not its distributions, so these are written out here.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint64_t index);

  /// 0 <= value < 1, 53 bits.
  [[nodiscard]] double uniform();
  /// Mean 0, variance 1 (Box and Muller 1958).
  [[nodiscard]] double normal();
  /// Student's t with `freedom` > 0 degrees of freedom, not scaled (Bailey 1994).
  [[nodiscard]] double student_t(double freedom);
  /// 0 .. count-1, count >= 1.
  [[nodiscard]] std::uint64_t below(std::uint64_t count);

 private:
  std::mt19937_64 engine_;
  std::optional<double> spare_normal_;
};

}  // namespace mpm::sim
