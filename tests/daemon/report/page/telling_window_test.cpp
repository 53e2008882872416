#include "daemon/report/page/telling_window.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test::telling_window_test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

TEST_CASE("the telling window lies inside a run, beside those that were shown") {
  std::vector<double> weights(100, 0.0);
  weights[30] = weights[70] = 5.0;
  weights[72] = kNaN;
  weights[75] = 1.0;
  const std::vector<Run> one = {{0, 100}};
  const Run best = telling_window(weights, one, 10, {});
  CHECK(best.count == 10);
  CHECK(best.first == 66);  // the first that holds 70 and 75
  const Run second = telling_window(weights, one, 10, {best});
  CHECK(second.first == 21);
  const Run cut = telling_window(weights, {{0, 72}, {72, 28}}, 10, {});
  CHECK(cut.first + cut.count <= 72);
  CHECK(telling_window(weights, one, 60, {{20, 60}}).count == 0);
  CHECK(window_around(40, one, 20).first == 35);
  CHECK(window_around(2, one, 20).first == 0);
  CHECK(window_around(99, one, 20).first == 80);
}

}  // namespace
}  // namespace mpm::test::telling_window_test
