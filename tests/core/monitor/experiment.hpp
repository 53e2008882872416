#pragma once

#include "core/monitor/monitor.hpp"
#include "tests/core/open_loop_unit.hpp"

namespace mpm::test {

/// A unit in open loop, and the monitor of its model.
struct Experiment : OpenLoopUnit {
  bool predictions = true;

  [[nodiscard]] Monitor monitor() const {
    return Monitor(model, counts, {predictions, predictions}, {}, {});
  }
};

}  // namespace mpm::test
