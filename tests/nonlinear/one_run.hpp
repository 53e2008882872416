#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/mismatch/verdict.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"
#include "tests/nonlinear/cases.hpp"
#include "tests/study/run.hpp"

namespace mpm::nonlinear {

/// What a run said of one channel at its end.
struct Reading {
  ChannelNonlinearity nonlinear;
  Verdict linear = Verdict::kUndetermined;
  Reason reason = Reason::kNone;
};

struct RunReadings {
  bool diverged = false;
  std::vector<Reading> channels;  ///< input * CVs + CV
};

/// Nothing, and the reason in `why_not`, where the case cannot be run.
[[nodiscard]] std::optional<study::Prepared> prepare_case(const Case& one, int samples,
                                                          NonlinearTest test, std::string& why_not);

[[nodiscard]] RunReadings run_case(const study::Prepared& prepared, std::uint64_t seed);

}  // namespace mpm::nonlinear
