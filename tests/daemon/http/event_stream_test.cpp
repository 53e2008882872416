#include "daemon/http/event_stream.hpp"

#include <catch2/catch.hpp>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("a late joiner gets the state at once, then news, then signs of life") {
  test::SampleBoard sample;
  sample.show(true);
  EventStream stream(sample.board, "run", "");
  bool ended = false;
  const std::string first = stream.next(ended);
  CHECK_THAT(first, Contains("retry: 2000\n\n"));
  CHECK_THAT(first, Contains("id: run-1\nevent: state\n"));
  CHECK_THAT(first, Contains(R"("units":{"column":1})"));
  sample.show(false);
  CHECK_THAT(stream.next(ended), Contains("id: run-2\n"));
  std::string life;
  for (int waits = 0; waits < 6 && life.empty(); ++waits) life = stream.next(ended);
  CHECK_THAT(life, Contains("event: alive\n"));
  CHECK_FALSE(ended);
  sample.board.close();
  CHECK(stream.next(ended).empty());
  CHECK(ended);
}

TEST_CASE("who comes back is told what it missed") {
  test::SampleBoard sample;
  sample.show(true);
  bool ended = false;
  EventStream same(sample.board, "run", "run-1");
  CHECK(same.next(ended) == "retry: 2000\n\n");
  EventStream behind(sample.board, "run", "run-0");
  CHECK_THAT(behind.next(ended), Contains("id: run-1"));
  EventStream other(sample.board, "run", "earlier-1");  // of another run
  CHECK_THAT(other.next(ended), Contains("id: run-1"));
}

}  // namespace
}  // namespace mpm::http
