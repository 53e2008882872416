#include "core/identify/diagnosis/undecided.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm::undecided_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::lag;

/// 2 ln of odds of 3 to 1.
const double kThreeToOne = 2.0 * std::log(3.0);

Finding finding_of(const Cause& cause, const Place& place, std::vector<Rival> rivals,
                   double acts_alike = 0.0) {
  Finding finding;
  finding.subject = {&cause, place};
  double total = 1.0 + acts_alike;
  for (const Rival& rival : rivals) total += std::exp(-0.5 * rival.worse);
  finding.confidence = 1.0 / total;
  finding.rivals = std::move(rivals);
  return finding;
}

TEST_CASE("a channel that is wrong in one way or another is no guess, one of two is") {
  const Rival same{{&causes::dead_time(), {0, 1}}, 0.0, true};
  const Rival all_of_input{{&causes::input_scale(), {-1, 1}}, 0.0, true};
  const Rival another{{&causes::gain(), {0, 2}}, 0.0, true};
  const Rival another_cv{{&causes::gain(), {1, 1}}, 0.0, true};
  const auto gain_beside = [](std::vector<Rival> rivals) {
    return finding_of(causes::gain(), {0, 1}, std::move(rivals));
  };
  // Closed form: of so many that are as probable, those that accuse a part of the same.
  CHECK(probability_of_place(gain_beside({})) == Approx(1.0));
  CHECK(probability_of_place(gain_beside({same})) == Approx(1.0));
  CHECK(probability_of_place(gain_beside({all_of_input})) == Approx(1.0));
  CHECK(probability_of_place(gain_beside({same, another})) == Approx(2.0 / 3.0));
  CHECK(probability_of_place(gain_beside({another, another_cv})) == Approx(1.0 / 3.0));
  CHECK_FALSE(is_guess(gain_beside({same, another})));
  CHECK(is_guess(gain_beside({another, another_cv})));
}

TEST_CASE("a disturbance accuses nobody, and an actuator is no part of a sensor") {
  const Rival disturbance{{&causes::step_disturbance(), {0, -1}}, 0.0, true};
  const Rival sensor{{&causes::output_scale(), {0, -1}}, 0.0, true};
  CHECK(probability_of_place(finding_of(causes::gain(), {0, 1}, {disturbance})) == Approx(0.5));
  CHECK(probability_of_place(finding_of(causes::input_scale(), {-1, 1}, {sensor})) == Approx(0.5));
  CHECK_FALSE(is_guess(finding_of(causes::step_disturbance(), {0, -1}, {sensor, sensor, sensor})));
}

TEST_CASE("beside what acts alike an actuator's offset is named only where it is the only one") {
  const Rival other{{&causes::input_offset(), {-1, 2}}, kThreeToOne, false};
  CHECK_FALSE(is_guess(finding_of(causes::input_offset(), {-1, 1}, {}, 1.0)));
  CHECK(is_guess(finding_of(causes::input_offset(), {-1, 1}, {other}, 1.0)));
  CHECK_FALSE(is_guess(finding_of(causes::input_scale(), {-1, 1}, {other})));
}

/// Two inputs act on two CVs, the second `second` times as much on the second CV, twice on the
/// first; the first begins to leak half-way.
Diagnosis leak_beside(double second, std::uint64_t seed) {
  constexpr Index kRows = 1500, kOnset = 500;
  constexpr double kLeak = 0.8;
  MatrixXd inputs(kRows, 2), cvs(kRows, 2);
  for (Index i = 0; i < 2; ++i)
    inputs.col(i) = test::telegraph(seed + static_cast<std::uint64_t>(i), kRows, 12);
  VectorXd acting = inputs.col(0);
  acting.tail(kRows - kOnset).array() += kLeak;
  const double gains[2][2] = {{1.0, 2.0}, {1.0, second}};
  for (Index j = 0; j < 2; ++j)
    cvs.col(j) = test::first_order(acting, gains[j][0], 10.0) +
                 test::first_order(inputs.col(1), gains[j][1], 10.0) +
                 0.1 * test::autoregressive(
                           test::white(seed + 10 + static_cast<std::uint64_t>(j), kRows), 0.5);
  DiagnosisSettings settings;
  settings.mv_count = 2;
  return diagnose(test::model_of({lag(0, 0, 1.0, 10.0), lag(0, 1, 2.0, 10.0), lag(1, 0, 1.0, 10.0),
                                  lag(1, 1, second, 10.0)},
                                 2, 2),
                  test::recording_of(inputs, cvs), nullptr, settings);
}

TEST_CASE("which of two actuators leaks is not said where both do the same to all CVs",
          "[trials]") {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    CAPTURE(seed);
    const Diagnosis apart = leak_beside(-1.0, seed);
    REQUIRE_FALSE(apart.findings.empty());
    CHECK(apart.findings.front().subject == Subject{&causes::input_offset(), {-1, 0}});

    const Diagnosis alike = leak_beside(2.0, seed);
    for (const Finding& finding : alike.findings) CHECK_FALSE(accuses(finding.subject));
    CHECK(alike.verdict != DiagnosisVerdict::kMatch);
    const auto undecided = [](const Finding& finding) {
      return finding.subject.cause == &causes::input_offset() &&
             finding.refused.find("do not decide") != std::string::npos;
    };
    CHECK(std::any_of(alike.refused.begin(), alike.refused.end(), undecided));
  }
}

}  // namespace
}  // namespace mpm::undecided_test
