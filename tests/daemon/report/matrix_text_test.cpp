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

TEST_CASE("tags are cut no further than they can be told apart") {
  const std::vector<MatrixRow> rows = {{"row", {{"m"}, {"m"}}}};
  CHECK(matrix_text({"FIC-101.SP>AI-201.PV", "FIC-101.SP>TI-201.PV"}, rows, {60, false}) ==
        "       FIC-101.SP>AI-201.PV  FIC-101.SP>TI-201.PV\n"
        "  row  m                     m\n");
}

}  // namespace mpm::report
