#include "core/identification/start_values.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("the search finds which inputs act, about how fast and how late") {
  const IdentificationData data = identification_data(open_loop(3000, 920));
  std::vector<ChannelHint> hints(3);
  for (int i = 0; i < 3; ++i) hints[static_cast<std::size_t>(i)].input = i;
  const HighOrderModel model = high_order_model(data, 0, 12);
  REQUIRE(model.sound);
  // Noise in open_loop(): 0.05, autoregressive, so that is the s.d. of the innovations.
  CHECK(std::sqrt(model.variance) == Approx(0.05).epsilon(0.05));
  const StartSearch search(model, hints, 1.0);
  std::vector<ChannelShape> best = search.best_sets().front();
  std::sort(best.begin(), best.end(),
            [](const ChannelShape& a, const ChannelShape& b) { return a.input < b.input; });
  REQUIRE(best.size() == 2);
  CHECK(best[0].input == 0);
  CHECK(best[0].gain == Approx(2.0).epsilon(0.1));
  CHECK(best[0].time_constant == Approx(12.0).epsilon(0.15));
  CHECK(best[0].dead_time == Approx(4.0).margin(1.0));
  CHECK(best[1].input == 2);
  CHECK(best[1].gain == Approx(-0.5).epsilon(0.15));
  CHECK_FALSE(search.enlarged(best));
  CHECK(search.enlarged({best[0]})->back().input == 2);
}

}  // namespace mpm::test
