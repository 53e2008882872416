#pragma once

#include <vector>

#include "config/unit_config.hpp"
#include "core/signal/frame.hpp"
#include "daemon/files/purpose.hpp"

namespace mpm::files {

/// What an input of a unit can be, by the limits that its file gives (`low`, `high`; both, or
/// nothing is known). Limits are moved, and a valve's position is measured beyond them; but a value
/// that lies outside by several times their distance is none: -9999 stands for one that is missing.
class InputRanges {
 public:
  /// Nothing is known to who keeps the values as they are.
  explicit InputRanges(const config::UnitConfig& unit, Purpose purpose = Purpose::kJudge);

  /// Marks such values as implausible. Allocates nothing.
  void mark(Frame& frame) const;

 private:
  struct Range {
    SignalKind kind = SignalKind::kMv;
    int index = 0;
    double low = 0.0, high = 0.0;  // of what can be, signal units
  };
  std::vector<Range> ranges_;
};

}  // namespace mpm::files
