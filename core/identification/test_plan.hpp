#pragma once

#include <optional>
#include <vector>

#include "core/identification/identification.hpp"

namespace mpm {

/// What the unit file allows.
struct TestLimits {
  struct Range {
    std::optional<double> low, high;
  };
  std::vector<Range> inputs, cvs;  ///< own units
};

enum class TestSignal {
  kSteps,   ///< up, down and back, each held for a settling time
  kBinary,  ///< a generalised binary noise: two levels that change at random (Tulleken 1990)
};

/// How one MV is to be moved so that its channels can be told.
struct PlannedTest {
  int input = 0;
  std::vector<int> cvs;  ///< whose channels are not known for want of movement
  TestSignal signal = TestSignal::kSteps;
  /// Half the distance of the levels, input units; nothing where neither limits nor movements say
  /// what is much.
  std::optional<double> amplitude;
  double hold_s = 0.0;      ///< of a step; of a binary signal the mean time at a level
  double duration_s = 0.0;  ///< of the whole test of this input
  double settling_s = 0.0;  ///< slowest settling time of those CVs, as far as known
};

/// For the MVs alone (`mv_count` first inputs) whose channels were left out because they moved too
/// little, also beside what their limits allow, or only by feedback. Amplitude from limits and from
/// what did not suffice; duration from the noise: an effect of a tenth of what the CV does is then
/// five s.d. of its estimate.
[[nodiscard]] std::vector<PlannedTest> test_plan(const Identification& identification,
                                                 const TestLimits& limits, int mv_count);

}  // namespace mpm
