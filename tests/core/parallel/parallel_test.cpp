#include "core/parallel/parallel.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace mpm {
namespace {

/// Takes a while, and the longer the larger `piece` is.
double worked(std::size_t piece) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 2000 * (piece % 7 + 1); ++k) sum += std::sin(static_cast<double>(k));
  return sum + static_cast<double>(piece);
}

TEST_CASE("each piece is done once, and pieces may have pieces of their own") {
  for (const int threads : {1, 2, 5}) {
    CAPTURE(threads);
    const Parallel parallel(threads);
    std::vector<std::vector<int>> done(40, std::vector<int>(9, 0));
    std::vector<double> results(40, 0.0);
    parallel.for_each(done.size(), [&](std::size_t i) {
      results[i] = worked(i);
      parallel.for_each(done[i].size(), [&](std::size_t j) { done[i][j] += 1; });
    });
    for (std::size_t i = 0; i < done.size(); ++i) {
      CHECK(done[i] == std::vector<int>(9, 1));
      CHECK(results[i] == worked(i));
    }
    parallel.for_each(0, [](std::size_t) { FAIL("there is no piece"); });
  }
}

struct Stop {};

TEST_CASE("what a piece throws ends all, and comes out as what it was") {
  for (const int threads : {1, 4}) {
    CAPTURE(threads);
    const Parallel parallel(threads);
    std::atomic<int> begun{0};
    const auto all = [&] {
      parallel.for_each(50, [&](std::size_t) {
        parallel.for_each(50, [&](std::size_t j) {
          ++begun;
          if (j == 3) throw Stop();
        });
      });
    };
    CHECK_THROWS_AS(all(), Stop);
    CHECK(begun < 50 * 50);
    std::atomic<int> after{0};
    parallel.for_each(50, [&](std::size_t) { ++after; });
    CHECK(after == 50);
  }
}

TEST_CASE("the thread that asks knows itself, and works too") {
  const Parallel parallel(3);
  CHECK(parallel.at_home());
  std::atomic<int> here{0};
  std::atomic<int> done{0};
  parallel.for_each(300, [&](std::size_t i) {
    worked(i);
    ++done;
    if (parallel.at_home()) ++here;
  });
  CHECK(done == 300);
  CHECK(here >= 1);
  const Parallel alone(1);
  alone.for_each(3, [&](std::size_t) { CHECK(alone.at_home()); });
}

}  // namespace
}  // namespace mpm
