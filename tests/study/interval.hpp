#pragma once

#include <cstdint>
#include <vector>

namespace mpm::study {

struct Interval {
  double low = 0.0;
  double high = 1.0;
};

/// 95 % interval of a share of `hits` in `total` independent trials (Wilson 1927); `total` need not
/// be whole.
[[nodiscard]] Interval wilson(double hits, double total);

/// 95 % interval of the mean of a Poisson count (Garwood 1936, exact). Where nothing was counted
/// the upper end is one-sided: 3.0.
[[nodiscard]] Interval poisson(std::int64_t count);

/// P(X >= hits) and P(X <= hits) for X binomial.
[[nodiscard]] double binomial_at_least(std::int64_t hits, std::int64_t total, double rate);
[[nodiscard]] double binomial_at_most(std::int64_t hits, std::int64_t total, double rate);

/// Hits and trials of one run.
struct Count {
  std::int64_t hits = 0;
  std::int64_t total = 0;
};

/// Whether trials of one run are taken as independent where no scatter between runs can tell
/// (all hits or none).
enum class Within { kIndependent, kOneTrial };

/// A share over runs that are independent of each other, with a 95 % interval. Trials within a run
/// may depend on each other: the interval is Wilson's with total / design_effect trials, the design
/// effect (>= 1) being the variance between runs over that of independent trials (Kish 1965).
struct Share {
  std::int64_t hits = 0;
  std::int64_t total = 0;
  double design_effect = 1.0;
  Interval interval;

  [[nodiscard]] double rate() const {
    return total > 0 ? static_cast<double>(hits) / static_cast<double>(total) : 0.0;
  }
  [[nodiscard]] double independent_trials() const {
    return static_cast<double>(total) / design_effect;
  }
};
[[nodiscard]] Share share_of(const std::vector<Count>& runs, Within within = Within::kIndependent);

/// The q-quantile (0..1) of values in any order, the nearest from below; infinite values allowed.
[[nodiscard]] double quantile(std::vector<double> values, double q);

}  // namespace mpm::study
