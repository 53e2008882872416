#include "daemon/http/board.hpp"

#include <catch2/catch.hpp>
#include <chrono>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

using namespace std::chrono_literals;

TEST_CASE("a version stands for what can be seen") {
  test::SampleBoard sample;
  CHECK(sample.board.version() == 0);
  sample.push(3);
  CHECK(sample.board.version() == 0);
  sample.show(true);
  CHECK(sample.board.version() == 1);
  CHECK(sample.board.find("nobody") == nullptr);
  CHECK(sample.board.feed_of("nobody") == nullptr);
}

TEST_CASE("who waits is woken by news, and by the end") {
  test::SampleBoard sample;
  sample.board.start();
  CHECK(sample.board.wait_beyond(0, Board::Clock::now() + 20ms) == 0);
  sample.show(true);
  CHECK(sample.board.wait_beyond(0, Board::Clock::now() + 10s) > 0);
  std::thread closer([&] {
    std::this_thread::sleep_for(20ms);
    sample.board.close();
  });
  const auto before = Board::Clock::now();
  (void)sample.board.wait_beyond(1000, before + 10s);
  CHECK(Board::Clock::now() - before < 5s);
  CHECK(sample.board.closed());
  closer.join();
}

}  // namespace
}  // namespace mpm::http
