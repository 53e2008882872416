#include "core/identification/high_order.hpp"

#include <catch2/catch.hpp>

#include "tests/core/identification/loop.hpp"

namespace mpm::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_CASE("blocks of lags follow each other without a gap") {
  for (const int longest : {1, 5, 40, 600}) {
    const std::vector<LagBlock> blocks = lag_blocks(longest);
    int next = 1;
    for (const LagBlock& block : blocks) {
      CHECK(block.first == next);
      CHECK(block.last >= block.first);
      next = block.last + 1;
    }
    CHECK(next == longest + 1);
  }
}

TEST_CASE("sums over blocks of lags are those of a plain loop, each run by itself") {
  const VectorXd u = white(901, 60);
  const std::vector<Run> runs = {{0, 25}, {25, 35}};
  const std::vector<LagBlock> blocks = {{1, 1}, {2, 2}, {3, 6}, {7, 15}};
  const MatrixXd sums = lagged_sums(u, blocks, runs);
  for (const Run& run : runs)
    for (Index k = run.first; k < run.first + run.count; ++k)
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        double sum = 0.0;
        for (Index l = blocks[b].first; l <= blocks[b].last; ++l)
          sum += u(std::max(run.first, k - l));
        CHECK(sums(k, static_cast<Index>(b)) == Approx(sum).margin(1e-12));
      }
}

}  // namespace mpm::test
