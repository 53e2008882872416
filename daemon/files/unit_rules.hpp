#pragma once

#include "daemon/files/calculator.hpp"
#include "daemon/files/input_ranges.hpp"

namespace mpm::files {

/// What a unit file says of the values of each frame, wherever that comes from: the rows of a file,
/// a recording, or the samples of a bus once they are aligned.
class UnitRules {
 public:
  explicit UnitRules(const config::UnitConfig& unit, Purpose purpose = Purpose::kJudge)
      : calculator_(unit), ranges_(unit, purpose) {}

  /// Calculates signals, then marks what inputs cannot be. Allocates nothing.
  void apply(Frame& frame) {
    calculator_.fill(frame);
    ranges_.mark(frame);
  }

 private:
  Calculator calculator_;
  InputRanges ranges_;
};

}  // namespace mpm::files
