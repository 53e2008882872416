#include "core/identification/structure.hpp"

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

}  // namespace mpm::test
