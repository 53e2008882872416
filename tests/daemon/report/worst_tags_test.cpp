#include "daemon/report/worst_tags.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("those with most bad values are named, three at most") {
  CHECK(worst_tags({}).empty());
  CHECK(worst_tags({{"u1", 2}, {"y1", 9}}) == ", of y1 (9), u1 (2)");
  CHECK(worst_tags({{"a", 1}, {"b", 4}, {"c", 3}, {"d", 2}, {"e", 1}}) ==
        ", of b (4), c (3), d (2) and 2 others");
}

}  // namespace mpm::report
