#pragma once

#include <cmath>

#include "tests/daemon/report/identification/small_run.hpp"

namespace mpm::test {

/// small_run() with data, and the response of its channel.
inline report::IdentificationRun identified_run() {
  report::IdentificationRun run = small_run();
  run.unit.model = {};
  run.recording.inputs = Eigen::MatrixXd::Zero(100, 2);
  run.recording.inputs.col(0).tail(60).setOnes();
  ChannelAnswer& known = run.identification.channels[0];
  for (int i = 0; i < 30; ++i) {
    known.step_times_s.push_back(i);
    known.step.push_back(2.0 * (1.0 - std::exp(-i / 8.0)));
    known.step_sd.push_back(0.05);
  }
  return run;
}

}  // namespace mpm::test
