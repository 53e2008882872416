#pragma once

#include <string>

#include "daemon/report/diagnosis/diagnosis_run.hpp"

namespace mpm::test {

/// Shell 3x3 with an ambient temperature that nobody's model knows, in which three things are
/// wrong: u3 -> y3 has 1.4 times the gain, t_amb acts on y1, and y2 lies higher from 2 100 s on.
/// The diagnosis is made by hand, and right.
[[nodiscard]] report::DiagnosisRun sample_run(int samples = 3000);

/// The same unit, where nothing was found.
[[nodiscard]] report::DiagnosisRun matching_run();

}  // namespace mpm::test
