#include "daemon/report/matrix_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("columns that find no room follow in a table of their own") {
  const std::vector<MatrixRow> rows = {{"u1", {{"m"}, {"mismatch"}, {"m"}}},
                                       {"", {{""}, {"why"}, {""}}}};
  CHECK(matrix_text({"y1", "y2", "y3"}, rows, {22, false}) ==
        "      y1   y2\n"
        "  u1  m    mismatch\n"
        "           why\n"
        "\n"
        "      y3\n"
        "  u1  m\n");
}

}  // namespace mpm::report
