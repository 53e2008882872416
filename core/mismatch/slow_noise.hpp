#pragma once

namespace mpm {

/// By how much slow noise is larger than a regression on its own past tells, >= 1: so much less
/// well are gains and time constants known. Of noise that A(q) e = w makes white the regression
/// finds A(1) = `own`, too large for each column that moves more slowly than the noise remembers:
/// by 2 / n where these take little of the noise with them (Kendall 1954, Kiviet and Phillips 1993,
/// for a pole near 1), by more as they take more. `rows`: n.
[[nodiscard]] double slow_noise_ratio(double own, double slow_columns, double rows);

}  // namespace mpm
