#include "core/statistics/f_distribution.hpp"

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace mpm {
namespace {

namespace policies = boost::math::policies;

// Data never throw. In double: long double is slower and not the same on every machine.
using Policy = policies::policy<
    policies::domain_error<policies::ignore_error>, policies::pole_error<policies::ignore_error>,
    policies::overflow_error<policies::ignore_error>,
    policies::evaluation_error<policies::ignore_error>, policies::promote_double<false>>;
using FisherF = boost::math::fisher_f_distribution<double, Policy>;

}  // namespace

double f_upper_tail(double statistic, double numerator, double denominator) {
  if (!(statistic > 0.0)) return 1.0;
  if (std::isinf(statistic)) return 0.0;
  return boost::math::cdf(boost::math::complement(FisherF(numerator, denominator), statistic));
}

double f_quantile(double probability, double numerator, double denominator) {
  return boost::math::quantile(
      boost::math::complement(FisherF(numerator, denominator), probability));
}

}  // namespace mpm
