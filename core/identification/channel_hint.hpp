#pragma once

#include <optional>

namespace mpm {

/// What the user knows of one channel before its identification.
struct ChannelHint {
  int cv = 0;
  int input = 0;
  bool no_relation = false;
  int sign = 0;                            ///< of the gain: 1 or -1; 0 = not known
  std::optional<double> dead_time_s = {};  ///< >= 0
  std::optional<bool> integrating = {};

  [[nodiscard]] bool operator==(const ChannelHint&) const = default;
};

}  // namespace mpm
