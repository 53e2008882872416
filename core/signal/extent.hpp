#pragma once

#include <array>
#include <cstddef>

#include "core/signal/calibration.hpp"

namespace mpm {

/// How far one signal has ever ranged, in plausible values. Of the first ones the outermost do not
/// count where they lie absurdly far from all others.
class Extent {
 public:
  /// Takes a plausible value; false where it turns out that some of the first ones were not.
  [[nodiscard]] bool learn(double value);
  void restart() { taken_ = 0; }

  /// Of the first values so many must have come.
  [[nodiscard]] bool known() const { return taken_ == kFirst; }
  /// High minus low, signal units; 0 where that is no more than the signal's last digits.
  [[nodiscard]] double width() const;
  /// How far a value lies outside, in widths: 0 inside, infinite outside where the width is 0.
  [[nodiscard]] double beyond(double value) const;

 private:
  static constexpr std::size_t kFirst = calibration::extent::kFirstValues;

  double low_ = 0.0, high_ = 0.0;
  std::size_t taken_ = 0;  // of the first
  std::array<double, kFirst> first_{};
};

}  // namespace mpm
