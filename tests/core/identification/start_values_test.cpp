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

// Sums of the same two lags, in exact terms: K (lead s + 1) / ((T s + 1)(T2 s + 1)) has the parts
// K (T - lead) / (T - T2) and K (lead - T2) / (T - T2).
TEST_CASE(
    "lags that channels share are found however poor the channels were, and leads with them") {
  const Index rows = 4000;
  constexpr double kSlow = 60.0, kFast = 9.0;
  const auto part = [&](const VectorXd& u, double gain, double lead) -> VectorXd {
    return first_order(u, gain * (kSlow - lead) / (kSlow - kFast), kSlow) +
           first_order(u, gain * (lead - kFast) / (kSlow - kFast), kFast);
  };
  MatrixXd inputs(rows, 2), cvs(rows, 1);
  inputs << telegraph(841, rows, 50), telegraph(842, rows, 70);
  cvs.col(0) =
      part(inputs.col(0), 3.0, 20.0) + part(inputs.col(1), -1.5, 0.0) + 0.05 * white(843, rows);
  const IdentificationData data = identification_data(recording_of(inputs, cvs));
  std::vector<ChannelHint> hints(2);
  for (int i = 0; i < 2; ++i) hints[static_cast<std::size_t>(i)].input = i;
  const HighOrderModel model = high_order_model(data, 0, 12);
  REQUIRE(model.sound);
  const StartSearch search(model, hints, 1.0);
  std::vector<ChannelShape> poor(2);
  for (int i = 0; i < 2; ++i) {
    poor[static_cast<std::size_t>(i)].input = i;
    poor[static_cast<std::size_t>(i)].gain = 1.0;
    poor[static_cast<std::size_t>(i)].time_constant = 25.0;
    poor[static_cast<std::size_t>(i)].dead_time = 3.0;
  }
  const auto shared = search.with_shared_lags(poor);
  REQUIRE(shared);
  REQUIRE(shared->size() == 2);
  for (const ChannelShape& shape : *shared) {
    CHECK(shape.form == ChannelForm::kSecondOrderLead);
    // The grid's times are 1.6 apart.
    CHECK(std::abs(std::log(shape.time_constant / kSlow)) < std::log(1.6));
  }
  CHECK((*shared)[0].time_constant == (*shared)[1].time_constant);
  CHECK((*shared)[0].second == (*shared)[1].second);
  CHECK((*shared)[0].gain == Approx(3.0).epsilon(0.1));
  CHECK((*shared)[1].gain == Approx(-1.5).epsilon(0.1));
  poor[0].sign = 1;
  CHECK_FALSE(search.with_shared_lags(poor));  // a part of the wrong sign may be the lead's
  CHECK_FALSE(search.with_shared_lags({}));
}

}  // namespace mpm::test
