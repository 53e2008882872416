#include "core/parallel/arena.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

namespace mpm {
namespace {

TEST_CASE("an arena runs every piece of a loop, on more threads than cores too") {
  Arena arena(2 * available_threads() + 1);
  std::vector<int> times(200, 0);
  const std::function<void(std::size_t)> piece = [&](std::size_t i) { ++times[i]; };
  Loop loop(piece);
  arena.run(times.size(), loop);
  CHECK(loop.done() == 200);
  CHECK(times == std::vector<int>(200, 1));
}

TEST_CASE("a piece that throws is not done") {
  Arena arena(2);
  const std::function<void(std::size_t)> piece = [](std::size_t i) {
    if (i == 7) throw std::runtime_error("seven");
  };
  Loop loop(piece);
  CHECK_THROWS_AS(arena.run(20, loop), std::runtime_error);
  CHECK(loop.done() < 20);
}

TEST_CASE("there is a thread at least") { CHECK(available_threads() >= 1); }

}  // namespace
}  // namespace mpm
