#pragma once

namespace mpm {

/// Upper tail P(F > statistic) of Fisher's F with `numerator` and `denominator` degrees of freedom
/// (both > 0, need not be whole), to a relative accuracy of about 1e-12 down to 1e-300. 1 for
/// statistic <= 0. By the regularised incomplete beta function, modified Lentz continued fraction
/// (Abramowitz and Stegun 1964, 26.6.2 and 26.5.8).
[[nodiscard]] double f_upper_tail(double statistic, double numerator, double denominator);

/// The statistic whose upper tail is `probability`, in (0, 1); relative accuracy 1e-10.
[[nodiscard]] double f_quantile(double probability, double numerator, double denominator);

}  // namespace mpm
