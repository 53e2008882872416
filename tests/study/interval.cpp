#include "tests/study/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm::study {
namespace {

constexpr double kNormal = 1.959963984540054;  // two-sided 95 %
constexpr double kTail = 0.025;

/// P(X <= count) for X Poisson.
double poisson_at_most(std::int64_t count, double mean) {
  double sum = 0.0;
  for (std::int64_t i = 0; i <= count; ++i)
    sum += std::exp(static_cast<double>(i) * std::log(mean) - mean -
                    std::lgamma(static_cast<double>(i) + 1.0));
  return sum;
}

/// The mean at which P(X <= count) falls to `probability`.
double poisson_mean(std::int64_t count, double probability) {
  double low = 0.0;
  double high = 2.0 * static_cast<double>(count) + 20.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (poisson_at_most(count, middle) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double binomial(std::int64_t hits, std::int64_t total, double rate) {
  const auto k = static_cast<double>(hits);
  const auto n = static_cast<double>(total);
  double log_p = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
  if (hits > 0) log_p += k * std::log(rate);
  if (hits < total) log_p += (n - k) * std::log1p(-rate);
  return std::exp(log_p);
}

}  // namespace

Interval wilson(double hits, double total) {
  if (!(total > 0.0)) return {};
  const double z2 = kNormal * kNormal;
  const double rate = hits / total;
  const double middle = (rate + z2 / (2.0 * total)) / (1.0 + z2 / total);
  const double half = kNormal / (1.0 + z2 / total) *
                      std::sqrt(rate * (1.0 - rate) / total + z2 / (4.0 * total * total));
  return {hits > 0.0 ? std::max(0.0, middle - half) : 0.0,
          hits < total ? std::min(1.0, middle + half) : 1.0};
}

Interval poisson(std::int64_t count) {
  if (count == 0) return {0.0, -std::log(2.0 * kTail)};
  return {poisson_mean(count - 1, 1.0 - kTail), poisson_mean(count, kTail)};
}

double binomial_at_least(std::int64_t hits, std::int64_t total, double rate) {
  double sum = 0.0;
  for (std::int64_t k = std::max<std::int64_t>(hits, 0); k <= total; ++k)
    sum += binomial(k, total, rate);
  return std::min(sum, 1.0);
}

double binomial_at_most(std::int64_t hits, std::int64_t total, double rate) {
  double sum = 0.0;
  for (std::int64_t k = 0; k <= std::min(hits, total); ++k) sum += binomial(k, total, rate);
  return std::min(sum, 1.0);
}

Share share_of(const std::vector<Count>& runs, Within within) {
  Share share;
  double used = 0.0;  // runs that had a trial
  for (const Count& run : runs) {
    share.hits += run.hits;
    share.total += run.total;
    used += run.total > 0 ? 1.0 : 0.0;
  }
  if (share.total == 0) return share;
  const double rate = share.rate();
  const auto total = static_cast<double>(share.total);
  if (share.hits == 0 || share.hits == share.total) {
    if (within == Within::kOneTrial) share.design_effect = total / used;
  } else if (used > 1.0) {
    double square = 0.0;
    for (const Count& run : runs) {
      const double miss = static_cast<double>(run.hits) - rate * static_cast<double>(run.total);
      square += miss * miss;
    }
    const double between = square / (total * total);
    share.design_effect = std::max(1.0, between * total / (rate * (1.0 - rate)));
  }
  share.interval =
      wilson(static_cast<double>(share.hits) / share.design_effect, share.independent_trials());
  return share;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::floor(q * last))];
}

}  // namespace mpm::study
