#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/signal/frame.hpp"

namespace mpm {

/// Names of one group of signals, in the order of their values.
struct SignalLayout {
  std::vector<std::string> tags;               ///< empty string = this CV has no such signal
  std::vector<std::string> engineering_units;  ///< as many; or empty
};

/// What a unit publishes. A kind without tags is not published at all.
struct UnitLayout {
  std::string unit;
  double sample_time_s = 1.0;
  std::array<SignalLayout, kSignalKindCount> signals;

  [[nodiscard]] SignalLayout& operator[](SignalKind kind) {
    return signals[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const SignalLayout& operator[](SignalKind kind) const {
    return signals[static_cast<std::size_t>(kind)];
  }
};

}  // namespace mpm
