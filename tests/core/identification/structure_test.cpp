#include "core/identification/structure.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("a channel with a slow tail gets its lead, one of two equal lags its second") {
  const Index rows = 4000;
  MatrixXd inputs(rows, 1), cvs(rows, 2);
  inputs << telegraph(821, rows, 60);
  // (12 s + 1) / ((4 s + 1)(20 s + 1)) = 0.5 / (4 s + 1) + 0.5 / (20 s + 1)
  cvs.col(0) = first_order(inputs.col(0), 0.5, 4.0) + first_order(inputs.col(0), 0.5, 20.0) +
               0.01 * white(822, rows);
  // 1 / (10 s + 1)^2 behind a hold: 1 - e^{-t/10} (1 + t/10), as a sum over the moves.
  cvs.col(1) = 0.01 * white(823, rows);
  for (Index j = 1; j < rows; ++j) {
    const double move = inputs(j, 0) - inputs(j - 1, 0);
    if (move == 0.0) continue;
    for (Index k = j + 1; k < rows; ++k) {
      const double t = static_cast<double>(k - j) / 10.0;
      cvs(k, 1) += move * (1.0 - std::exp(-t) * (1.0 + t));
    }
  }
  const Identification found = identify(recording_of(inputs, cvs), {});
  const ChannelAnswer& lead = answer_of(found, 0, 0);
  REQUIRE(lead.form == ChannelForm::kSecondOrderLead);
  CHECK(lead.dynamics->lead_s == Approx(12.0).epsilon(0.1));
  const ChannelAnswer& second = answer_of(found, 1, 0);
  REQUIRE(second.form == ChannelForm::kSecondOrder);
  CHECK(second.dynamics->time_constants_s[0] + second.dynamics->time_constants_s[1] ==
        Approx(20.0).epsilon(0.05));
}

TEST_CASE("a third lag is found, and a quick answer that creeps on") {
  const Index rows = 5000;
  MatrixXd inputs(rows, 1), cvs(rows, 2);
  inputs << telegraph(831, rows, 40);
  // A lag of 1.6 before (143 s + 1) / ((65 s + 1)(4 s + 1)) = 2.2787 / (4 s + 1) - 1.2787 / (65 s +
  // 1).
  const VectorXd behind = first_order(inputs.col(0), 1.0, 1.6);
  cvs.col(0) = first_order(behind, 2.2787, 4.0) - first_order(behind, 1.2787, 65.0) +
               0.05 * white(832, rows);
  // 0.84 within two samples, the rest over 50: (42.3 s + 1) / ((1.1 s + 1)(50 s + 1)) or so.
  cvs.col(1) = first_order(inputs.col(0), 0.84, 1.1) + first_order(inputs.col(0), 0.16, 50.0) +
               0.01 * white(833, rows);
  const Identification found = identify(recording_of(inputs, cvs), {});
  const ChannelAnswer& third = answer_of(found, 0, 0);
  REQUIRE(third.form == ChannelForm::kThirdOrderLead);
  CHECK(third.dynamics->gain == Approx(1.0).epsilon(0.05));
  REQUIRE(third.dynamics->time_constants_s.size() == 3);
  CHECK(third.dynamics->lead_s == Approx(143.0).epsilon(0.1));
  CHECK(*std::max_element(third.dynamics->time_constants_s.begin(),
                          third.dynamics->time_constants_s.end()) == Approx(65.0).epsilon(0.1));
  const ChannelAnswer& creeping = answer_of(found, 1, 0);
  REQUIRE(creeping.form == ChannelForm::kSecondOrderLead);
  CHECK(creeping.dynamics->gain == Approx(1.0).epsilon(0.02));
  CHECK(std::max(creeping.dynamics->time_constants_s[0], creeping.dynamics->time_constants_s[1]) ==
        Approx(50.0).epsilon(0.2));
}

TEST_CASE("a channel integrates, or does not, where the user said so") {
  // A lag of 400 samples seen for 1500, under noise: the data alone would leave either.
  const Index rows = 1500;
  MatrixXd inputs(rows, 1), cvs(rows, 1);
  inputs << telegraph(841, rows, 60);
  cvs.col(0) = first_order(inputs.col(0), 4.0, 400.0) + 0.2 * white(842, rows);
  const auto found_with = [&](std::optional<bool> integrating) {
    IdentificationSettings settings;
    if (integrating) settings.hints = {{0, 0, false, 0, {}, integrating}};
    return identify(recording_of(inputs, cvs), settings);
  };
  const Identification given = found_with(true);
  const ChannelAnswer& level = answer_of(given, 0, 0);
  REQUIRE(level.dynamics);
  CHECK(integrates(level.form));
  CHECK(level.dynamics->gain == Approx(0.01).epsilon(0.3));  // 4 / 400 a sample, at first
  const Identification refused = found_with(false);
  const ChannelAnswer& lag = answer_of(refused, 0, 0);
  REQUIRE(lag.dynamics);
  CHECK_FALSE(integrates(lag.form));
}

}  // namespace mpm::test
