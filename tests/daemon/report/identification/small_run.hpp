#pragma once

#include <string>

#include "config/load_unit.hpp"
#include "daemon/report/identification/identification_run.hpp"

namespace mpm::test {

inline const std::string kSignals = "signals:\n  mv: [u, v]\n  cv: [y]\n";

/// One channel identified, one left out.
inline report::IdentificationRun small_run() {
  report::IdentificationRun run;
  run.unit = config::load_unit_text("unit: u\nsample_time: 1\n" + kSignals, "u.yaml",
                                    config::ModelNeed::kMayBeMissing)
                 .config;
  run.recording.cvs = Eigen::MatrixXd::Zero(100, 1);
  run.program = "mpm";
  run.data_file = "a.csv";
  run.out_file = "new.yaml";
  Identification& found = run.identification;
  found.model = run.unit.model;
  ChannelAnswer known;
  known.left_out = LeftOut::kIdentified;
  known.dynamics = TransferFunction{2.0, {8.0}, 0.0, 1.0, false};
  known.gain = {1.9, 2.1};
  known.dead_time_s = {0.8, 1.2};
  known.time_constants = {{7.0, 9.0}};
  known.p_value = 1e-30;
  known.contribution = 0.9;
  ChannelAnswer other;
  other.input = 1;
  other.left_out = LeftOut::kStill;
  found.channels = {known, other};
  found.model.channels = {{0, 0, *known.dynamics, {}}};
  found.model.input_origin(0) = 5.0;
  found.cvs.resize(1);
  found.outside_shares = {0.9, std::nullopt};
  found.input_spread = {1.0, 0.0};
  return run;
}

}  // namespace mpm::test
