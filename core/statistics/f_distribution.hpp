#pragma once

namespace mpm {

/// Upper tail P(F > statistic) of Fisher's F with `numerator` and `denominator` degrees of freedom
/// (both > 0, need not be whole), by Boost.Math: to a relative accuracy of about 1e-12 down to
/// 1e-250, of some per cent down to 1e-306. 1 for a statistic that is not positive.
[[nodiscard]] double f_upper_tail(double statistic, double numerator, double denominator);

/// The statistic whose upper tail is `probability`, in (0, 1); relative accuracy 1e-12.
[[nodiscard]] double f_quantile(double probability, double numerator, double denominator);

}  // namespace mpm
