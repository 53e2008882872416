#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/proposals.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::input_product_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kRows = 2000;

/// Many levels, held for a while each.
VectorXd moves(std::uint64_t stream, Index hold) {
  return VectorXd::NullaryExpr(kRows,
                               [=](Index k) { return 2.0 * test::uniform(stream, k / hold); });
}

/// Two inputs on two CVs, gains of 2 and 1 on the first, 1 and 1.5 on the second.
struct Bench {
  VectorXd u = moves(7, 15), v = moves(8, 21);
  ModelSpec model = test::model_of({test::lag(0, 0, 2.0, 10.0, 2.0), test::lag(0, 1, 1.0, 6.0),
                                    test::lag(1, 0, 1.0, 8.0), test::lag(1, 1, 1.5, 12.0, 1.0)},
                                   2, 2);

  /// What `mpm diagnose` says where the CVs see these in place of u.
  [[nodiscard]] Diagnosis diagnosed(const VectorXd& in_first, const VectorXd& in_second) const {
    MatrixXd inputs(kRows, 2), cvs(kRows, 2);
    inputs << u, v;
    const auto noise = [](std::uint64_t stream) {
      return test::autoregressive(0.05 * test::normal(stream, kRows), 0.8);
    };
    cvs.col(0) =
        test::first_order(in_first, 2.0, 10.0, 2) + test::first_order(v, 1.0, 6.0) + noise(3);
    cvs.col(1) =
        test::first_order(in_second, 1.0, 8.0) + test::first_order(v, 1.5, 12.0, 1) + noise(4);
    DiagnosisSettings settings;
    settings.mv_count = 2;
    return diagnose(model, test::recording_of(inputs, cvs), nullptr, settings);
  }
};

}  // namespace

TEST_CASE("an input whose effect goes with another one's place is found, with that one and how") {
  const bool whole_input = GENERATE(true, false);
  const double per_unit = GENERATE(0.15, -0.3);
  CAPTURE(whole_input, per_unit);
  const Bench bench;
  const VectorXd acting = bench.u.array() * (0.9 + per_unit * bench.v.array());
  const Diagnosis diagnosis = bench.diagnosed(acting, whole_input ? acting : bench.u);
  REQUIRE(diagnosis.findings.size() == 1);
  const Finding& finding = diagnosis.findings[0];
  CHECK(finding.subject.cause == &causes::input_product());
  CHECK(finding.subject.place == Place{whole_input ? -1 : 0, 0});
  CHECK(finding.other_input == 1);
  CHECK(finding.confidence > 0.9);
  for (const auto& [name, truth] : {std::pair{"per_unit", per_unit}, std::pair{"linear", 0.9}}) {
    const Parameter* parameter = finding.find(test::quantity_of(causes::input_product(), name));
    REQUIRE(parameter != nullptr);
    CAPTURE(name, parameter->value, parameter->low, parameter->high);
    // 95 % intervals, held to twice their width.
    CHECK(std::abs(parameter->value - truth) < parameter->high - parameter->low);
    CHECK(parameter->value == Approx(truth).margin(0.03));
  }
  CHECK(finding.repaired);
  // The repaired model explains what the old one did not, on samples that were not fitted: what is
  // left is the noise.
  for (const CvScore& score : diagnosis.scores)
    CHECK(score.rmse_after < 1.1 * 0.05 / std::sqrt(1.0 - 0.8 * 0.8));
}

TEST_CASE("gains, a parabola and a sound plant are no products") {
  const Bench bench;
  const auto only = [](const Diagnosis& diagnosis) {
    REQUIRE(diagnosis.findings.size() == 1);
    return diagnosis.findings[0].subject.cause;
  };
  CHECK(only(bench.diagnosed(1.3 * bench.u, bench.u)) == &causes::gain());
  const VectorXd bent = bench.u.array() + 0.15 * bench.u.array().square();
  CHECK(only(bench.diagnosed(bent, bent)) == &causes::input_polynomial());
  CHECK(bench.diagnosed(bench.u, bench.u).findings.empty());
}

TEST_CASE("a product is looked for with each other input that moves, and not in its like's place") {
  Bench bench;
  const auto products = [&](const std::vector<Effect>& accepted) {
    MatrixXd inputs(kRows, 2);
    inputs << bench.u, bench.v;
    const Recording recording = test::recording_of(inputs, MatrixXd::Random(kRows, 2));
    Problem problem(bench.model, 2, recording, Tolerances{}, NoiseModel{});
    const Fit fit = problem.fit({}, 0, {0, 1});
    std::vector<Effect> found;
    causes::input_product().propose({problem, accepted, fit.cvs}, found);
    std::erase_if(found, [&](const Effect& mine) {
      return std::any_of(accepted.begin(), accepted.end(), [&](const Effect& other) {
        return !cause_of(mine).goes_with(other, mine);
      });
    });
    return found;
  };
  // Of both inputs, before the plant and before each of two CVs.
  const std::vector<Effect> all = products({});
  CHECK(all.size() == 6);
  for (const Effect& effect : all) CHECK(effect.other_input == 1 - effect.place.input);
  CHECK(products({all.front()}).size() == 3);
  bench.v.setConstant(0.5);
  CHECK(products({}).empty());
}

}  // namespace mpm::input_product_test
