#pragma once

#include "config/unit_config.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::sim {

/// v(k) = pole v(k-1) + sigma w(k), w white and normal: z / (z - pole) w (Carlsson 2010, eq. 4.2).
/// Starts from rest.
class ColouredNoise {
 public:
  ColouredNoise(const config::NoiseSettings& settings, RandomStream stream)
      : settings_(settings), stream_(stream) {}

  /// The next value; `sigma_ratio` scales the present innovation.
  [[nodiscard]] double next(double sigma_ratio = 1.0) {
    return advance(sigma_ratio * stream_.normal());
  }
  /// The next value from an innovation of its own (s.d. 1) in place of the normal one, of which one
  /// is drawn all the same, so that later ones do not change.
  [[nodiscard]] double next_with(double innovation) {
    static_cast<void>(stream_.normal());
    return advance(innovation);
  }

 private:
  [[nodiscard]] double advance(double innovation) {
    value_ = settings_.pole * value_ + settings_.sigma * innovation;
    return value_;
  }

  config::NoiseSettings settings_;
  RandomStream stream_;
  double value_ = 0.0;
};

}  // namespace mpm::sim
