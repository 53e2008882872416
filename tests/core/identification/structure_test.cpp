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
  // Behind an answer that overshoots, 2.5 / (5 s + 1) - 1.5 / (60 s + 1), a lag of 5: together
  // (142.5 s + 1) / ((5 s + 1)^2 (60 s + 1)).
  const VectorXd behind = first_order(inputs.col(0), 1.0, 5.0);
  cvs.col(0) =
      first_order(behind, 2.5, 5.0) - first_order(behind, 1.5, 60.0) + 0.01 * white(832, rows);
  // 0.84 within two samples, the rest over 50: (42.3 s + 1) / ((1.1 s + 1)(50 s + 1)) or so.
  cvs.col(1) = first_order(inputs.col(0), 0.84, 1.1) + first_order(inputs.col(0), 0.16, 50.0) +
               0.01 * white(833, rows);
  const Identification found = identify(recording_of(inputs, cvs), {});
  const ChannelAnswer& third = answer_of(found, 0, 0);
  REQUIRE(third.form == ChannelForm::kThirdOrderLead);
  CHECK(third.dynamics->gain == Approx(1.0).epsilon(0.05));
  REQUIRE(third.dynamics->time_constants_s.size() == 3);
  CHECK(third.dynamics->time_constants_s[1] + third.dynamics->time_constants_s[2] +
            third.dynamics->dead_time_s ==
        Approx(10.0).epsilon(0.1));
  const ChannelAnswer& creeping = answer_of(found, 1, 0);
  REQUIRE(creeping.form == ChannelForm::kSecondOrderLead);
  CHECK(creeping.dynamics->gain == Approx(1.0).epsilon(0.02));
  CHECK(std::max(creeping.dynamics->time_constants_s[0], creeping.dynamics->time_constants_s[1]) ==
        Approx(50.0).epsilon(0.2));
}

}  // namespace mpm::test
