#include "daemon/bus/input_stream.hpp"

#include <catch2/catch.hpp>

namespace mpm::bus::input_stream_test {
namespace {

using std::chrono::seconds;
constexpr std::int64_t kSecond = 1'000'000'000;

/// One sample a second from a hand-moved clock.
struct Line {
  void send(std::int64_t interval, std::uint64_t writer = 1) {
    stream.push({writer, interval, interval * kSecond, 1, 0}, 1.0, now);
    now += seconds(1);
  }
  InputStream::Clock::time_point now{seconds(1000)};
  InputStream stream;
};

}  // namespace

TEST_CASE("an input stream counts per writer what was repeated and left out") {
  Line line;
  CHECK_FALSE(line.stream.started());
  for (const std::int64_t interval : {1, 2, 2, 2, 5, 4, 6}) line.send(interval);
  const InputStream::Writer& writer = line.stream.writers()[0];
  CHECK(writer.samples == 7);
  CHECK(writer.repeated == 2);
  CHECK(writer.skipped == 2);  // 3 and 4; that 4 came later does not undo it
  CHECK(writer.standing == 0);
  CHECK(writer.interval == 6);
  CHECK_FALSE(line.stream.jump());
  CHECK_FALSE(line.stream.clock_step());
}

TEST_CASE("a counter that goes back while the source time goes on begins anew") {
  InputStream stream;
  InputStream::Clock::time_point now{seconds(1000)};
  std::int64_t time_s = 0;
  for (std::int64_t k = 1; k <= 20; ++k) stream.push({1, k, ++time_s * kSecond, 1, 0}, 1.0, now);
  stream.push({1, 10, 10 * kSecond, 1, 0}, 1.0, now);  // late
  CHECK(stream.writers()[0].interval == 20);
  CHECK_FALSE(stream.jump());
  stream.push({1, 5, ++time_s * kSecond, 1, 0}, 1.0, now);
  CHECK(stream.writers()[0].interval == 5);
  REQUIRE(stream.jump());
  CHECK(stream.jump()->from == 20);
  CHECK(stream.jump()->to == 5);
}

TEST_CASE("a stall whose end comes as much later is no step of the clock") {
  const bool stalled = GENERATE(true, false);
  InputStream stream;
  InputStream::Clock::time_point now{seconds(1000)};
  std::int64_t time_s = 0;
  for (std::int64_t k = 1; k <= 20; ++k) {
    if (k == 10) {
      time_s += 300;
      if (stalled) now += seconds(299);  // not to the second
    }
    stream.push({1, k, ++time_s * kSecond, 1, 0}, 1.0, now += seconds(1));
  }
  CHECK(stream.clock_step().has_value() == !stalled);
}

TEST_CASE("more writers than there is room for push out the one that is silent for longest") {
  Line line;
  for (std::uint64_t writer = 1; writer <= InputStream::kMostWriters + 1; ++writer)
    line.send(static_cast<std::int64_t>(writer), writer);
  for (const InputStream::Writer& writer : line.stream.writers()) CHECK(writer.handle != 1);
}

TEST_CASE("a source that gives no time has no clock that could step") {
  InputStream stream;
  InputStream::Clock::time_point now{seconds(1000)};
  for (std::int64_t k = 0; k < 5; ++k) stream.push({1, 100 * k, 0, 1, 0}, 60.0, now += seconds(1));
  CHECK_FALSE(stream.clock_step());
  CHECK(stream.jump()->from == 300);
  CHECK(stream.jump()->to == 400);
}

}  // namespace mpm::bus::input_stream_test
