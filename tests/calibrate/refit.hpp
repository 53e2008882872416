#pragma once

#include <string>
#include <vector>

#include "tests/calibrate/readings.hpp"

/// The fitted constants of core/mismatch/calibration.hpp, fitted again.
namespace mpm::calibrate {

/// One constant, as it is and as these loops would have it.
struct Refit {
  std::string name;
  double now = 0.0;
  double fitted = 0.0;
  double low = 0.0, high = 0.0;  ///< 95 % interval, by a bootstrap over runs (Efron 1979)
  std::string rule;              ///< by which it is fitted
  /// False: of tails that count as heavy from there on, the larger, the fewer do.
  bool larger_is_stricter = true;

  /// The one in use is laxer than the fitted one by four s.d. (twice the half interval), which
  /// chance makes it in 1 of 30 000 fits. Not where these loops cannot tell (infinite).
  [[nodiscard]] bool too_lax() const {
    return larger_is_stricter ? now < fitted - 2.0 * (fitted - low)
                              : now > fitted + 2.0 * (high - fitted);
  }
};

/// The factor for few rows with which p < 0.05 comes in 5 % of the readings of `rows_per_column`
/// from `fewest` to `most`: as F / (1 + factor c) is beyond its critical value exactly where factor
/// < (F / critical - 1) / c, that is the 95 % quantile of the right-hand side.
enum class Test { kDirected, kBlock };
[[nodiscard]] Refit refit_few_rows(const std::vector<Run>& runs, Test test, int fewest, int most);

/// The fewest rows per column from which on p < `level` comes at most `tolerance` times as often as
/// it should, with the factors as they are. Infinite where even the most do not do.
[[nodiscard]] Refit refit_rows_needed(const std::vector<Run>& runs, double level, double tolerance);

/// The quantile of the shares of clipped rows, CVs and runs together.
[[nodiscard]] Refit refit_clipped_share(const std::vector<Run>& runs, double quantile);

/// How often p < each of `levels` comes, by rows per column: a table in Markdown.
[[nodiscard]] std::string tail_table(const std::vector<Run>& runs,
                                     const std::vector<double>& levels);

}  // namespace mpm::calibrate
