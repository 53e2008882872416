#include "core/identify/fit/convolution.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The sum that a convolution is, term by term.
VectorXd summed(const VectorXd& response, const VectorXd& x, double x_before) {
  return VectorXd::NullaryExpr(x.size(), [&](Index k) {
    double sum = 0.0;
    for (Index l = 1; l <= response.size(); ++l)
      sum += response(l - 1) * (k >= l ? x(k - l) : x_before);
    return sum;
  });
}

// Shorter and longer than the data, whose lengths are no powers of two, and from another rest.
TEST_CASE("a convolution is the sum that it stands for") {
  constexpr Index kRows = 300;
  const VectorXd x = test::white(1, kRows);
  for (const Index taps : {1, 7, 299, 300, 301, 900}) {
    CAPTURE(taps);
    const VectorXd response = test::white(2, taps);
    const VectorXd expected = summed(response, x, -1.5);
    const double largest = expected.cwiseAbs().maxCoeff();
    CHECK((convolved(response, x, -1.5) - expected).cwiseAbs().maxCoeff() < 1e-12 * largest);
  }
}

TEST_CASE("one row has no past but the rest") {
  CHECK(convolved(VectorXd::Constant(3, 0.5), VectorXd::Constant(1, 9.0), 2.0)(0) == Approx(3.0));
}

}  // namespace
}  // namespace mpm
