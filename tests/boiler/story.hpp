#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/boiler/live_run.hpp"

namespace mpm::boiler {

/// How long the parts of the story are, control intervals.
struct StoryPlan {
  std::uint64_t seed = 1;
  int rest = 360;
  int test = 5400;     ///< identification
  int compare = 1000;  ///< control before and after
  int watch = 3000;    ///< for the monitor's verdicts and the diagnoses
  std::vector<std::string> others = {"fouled_superheater", "sticking_spray_valve",
                                     "o2_analyser_drift",  "drier_liquor",
                                     "growing_char_bed",   "leaking_damper"};
  std::string seen_by_aux = "drier_liquor";  ///< of these, what an auxiliary measurement sees
};

/// One of the further hidden changes.
struct HiddenChange {
  std::string scenario, description;
  LiveRun run;
  Json diagnosis;
  Json with_aux;  ///< diagnosis of the same run with auxiliary measurements; null where not made
};

/// All that happened, for the page.
struct Story {
  StoryPlan plan;
  std::string rest, test, validation;  ///< data files
  Json identified;                     ///< of `mpm identify --json`
  LiveRun commissioned, mismatch, repaired;
  LiveRun healthy, changed;                ///< long ones
  Json diagnosis;                          ///< report.json of the changed run
  Json healthy_diagnosis;                  ///< and of the one in which nothing is hidden
  std::vector<double> test_point;          ///< about which the MVs move in the second test
  std::vector<std::string> suspected_cvs;  ///< that its findings name
  Json identified_again;                   ///< these alone; null where there is none
  std::vector<HiddenChange> others;
  double seconds = 0.0;

  std::vector<Command> made_rest, made_model, made_validation, made_diagnosis, made_repair;
};

inline const std::string kCommissionedModel = "commissioned.yaml";
inline const std::string kRepairedModel = "repaired.yaml";

/// Plays it with real processes, in the workshop's folder. Throws StoryError.
[[nodiscard]] Story play(Workshop& workshop, const StoryPlan& plan);

}  // namespace mpm::boiler
