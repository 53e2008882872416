#include "daemon/report/page/plot_json.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test::plot_json_test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

TEST_CASE("a thinned series keeps its spikes and stays within its points") {
  std::vector<double> values(100'000, 0.0);
  values[50'123] = 8.0;
  values[50'124] = -8.0;
  const std::size_t every = thinning(values.size(), 400);
  const Envelope thin = envelope_of(values, every);
  CHECK(thin.low.size() <= 400);
  CHECK(*std::max_element(thin.high.begin(), thin.high.end()) == 8.0);
  CHECK(*std::min_element(thin.low.begin(), thin.low.end()) == -8.0);
  CHECK(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(0) == 2.0);
  CHECK(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(1) == 5.0);
  CHECK(std::isnan(means_of({1.0, 3.0, kNaN, 5.0, kNaN, kNaN, 7.0}, 2).at(2)));
  CHECK(means_of(values, 1) == values);
}

TEST_CASE("digits that cannot be seen are not written") {
  CHECK(visible_digits({0.123456, 10.0, kNaN, -1e-9}).dump() == "[0.12,10.0,null,0.0]");
  CHECK(visible_digits({123456.0, 123456.0}).dump() == "[123456.0,123456.0]");
}

}  // namespace
}  // namespace mpm::test::plot_json_test
