#include "daemon/report/page/residual_views.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test::residual_views_test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

TEST_CASE("blocks and levels know what is unknown") {
  CHECK(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(0) == 3.0);
  CHECK(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(1) == 4.0);
  CHECK(std::isnan(block_rms({3.0, 3.0, kNaN, 4.0, kNaN}, 2).at(2)));

  // A level that rests is one part, whatever the number of parts asked for.
  const LevelBins bins = level_bins({1.0, 1.0, 1.0, 1.0, 2.0, kNaN, 3.0, 3.0}, 4);
  REQUIRE(bins.level.size() == 3);
  CHECK(bins.level == std::vector<double>{1.0, 2.0, 3.0});
  const LevelView view = over_levels(bins, {1.0, -1.0, 1.0, -1.0, 5.0, 9.0, kNaN, 2.0});
  CHECK(view.rms == std::vector<double>{1.0, 5.0, 2.0});
  CHECK(view.mean == std::vector<double>{0.0, 5.0, 2.0});
}

}  // namespace
}  // namespace mpm::test::residual_views_test
