#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::input_two_sided_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kRows = 2000;

/// What `mpm diagnose` says of a first-order plant of gain 2 that gets `acting` where its input is
/// `u`.
Diagnosis diagnosed(const VectorXd& u, const VectorXd& acting) {
  const VectorXd y = test::first_order(acting, 2.0, 10.0, 2) +
                     test::autoregressive(0.05 * test::normal(3, kRows), 0.8);
  DiagnosisSettings settings;
  settings.mv_count = 1;
  return diagnose(test::model_of({test::lag(0, 0, 2.0, 10.0, 2.0)}, 1, 1), test::recording_of(u, y),
                  nullptr, settings);
}

/// Many levels, held for a while each.
VectorXd moves() {
  return VectorXd::NullaryExpr(kRows, [](Index k) { return 2.0 * test::uniform(7, k / 15); });
}

}  // namespace

TEST_CASE(
    "an input that does more on one side of a point is found, with both ratios and the point") {
  const double above = GENERATE(1.4, 0.6);
  const double below = 1.0, at = 0.4;
  CAPTURE(above);
  const VectorXd u = moves();
  // At the operating point, 0, nothing is added.
  const VectorXd acting =
      u.unaryExpr([&](double x) { return x < at ? below * x : below * at + above * (x - at); });
  const Diagnosis diagnosis = diagnosed(u, acting);
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings[0];
  CHECK(finding.subject.cause == &causes::input_two_sided());
  CHECK(finding.confidence > 0.9);
  for (const auto& [name, truth] :
       {std::pair{"above", above}, std::pair{"below", below}, std::pair{"at", at}}) {
    const Parameter* parameter = finding.find(test::quantity_of(causes::input_two_sided(), name));
    REQUIRE(parameter != nullptr);
    CAPTURE(name, parameter->value, parameter->low, parameter->high);
    // 95 % intervals, held to twice their width.
    CHECK(std::abs(parameter->value - truth) < parameter->high - parameter->low);
    CHECK(parameter->value == Approx(truth).margin(0.1));
  }
  CHECK(finding.repaired);
}

TEST_CASE("a gain alike on both sides, a parabola and a stop are called what they are") {
  const VectorXd u = moves();
  const auto only = [](const Diagnosis& diagnosis) {
    REQUIRE(diagnosis.findings.size() == 1);
    return diagnosis.findings[0].subject.cause;
  };
  CHECK(only(diagnosed(u, 1.3 * u)) == &causes::gain());
  CHECK(only(diagnosed(u, u.array() + 0.15 * u.array().square())) == &causes::input_polynomial());
  CHECK(only(diagnosed(u, u.cwiseMin(1.0))) == &causes::input_saturation());
  CHECK(diagnosed(u, u).findings.empty());
}

}  // namespace mpm::input_two_sided_test
