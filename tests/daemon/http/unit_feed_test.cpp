#include "daemon/http/unit_feed.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

using namespace std::chrono_literals;

TEST_CASE("frames are noted with their values and judgements, which come later") {
  test::SampleBoard sample;
  UnitFeed feed(sample.unit);
  for (int k = 1; k <= 10; ++k) {
    const Frame frame = test::frame_at(k, sample.unit.counts());
    sample.monitor.push(frame);
    feed.on_frame(frame, sample.monitor);
  }
  Delivery delivery;
  feed.fetch(delivery);
  CHECK(delivery.rows.size() == 1);  // offered at once; the others meanwhile
  CHECK(delivery.values[0] == 1.0F);
  delivery.clear();
  feed.offer();
  feed.fetch(delivery);
  REQUIRE(delivery.rows.size() == 9);
  const FeedColumns columns{2, 3};
  REQUIRE(delivery.values.size() == 9U * static_cast<std::size_t>(columns.width()));
  CHECK(delivery.values[static_cast<std::size_t>(columns.measured(1))] == 2.0F);
  CHECK(std::isnan(delivery.values[static_cast<std::size_t>(columns.prediction(1))]));
  CHECK(delivery.values[static_cast<std::size_t>(columns.input(2))] == 200.0F);
  CHECK(delivery.judged.size() < 9);
  CHECK(delivery.rows.back().judged == delivery.judged.size());

  delivery.clear();
  feed.fetch(delivery);
  CHECK(delivery.rows.empty());
}

TEST_CASE("a view is wanted twice a second while frames come, and seldom else") {
  test::SampleBoard sample;
  UnitFeed feed(sample.unit);
  const auto start = UnitFeed::Clock::now();
  CHECK(feed.wants_view(start));
  CHECK_FALSE(feed.wants_view(start + 600ms));
  feed.on_alarm({}, "");
  CHECK(feed.wants_view(start + 600ms));
  CHECK_FALSE(feed.wants_view(start + 1200ms));
  CHECK(feed.wants_view(start + 2700ms));
}

TEST_CASE("what nobody fetches is dropped and counted") {
  test::SampleBoard sample;
  UnitFeed feed(sample.unit);
  const Frame frame = test::frame_at(1, sample.unit.counts());
  sample.monitor.push(frame);
  feed.on_frame(frame, sample.monitor);  // offered
  for (std::size_t k = 0; k < UnitFeed::kMostRows + 5; ++k) feed.on_frame(frame, sample.monitor);
  Delivery delivery;
  feed.fetch(delivery);
  CHECK(delivery.rows.size() == 1);
  delivery.clear();
  feed.offer();
  feed.fetch(delivery);
  CHECK(delivery.rows.size() == UnitFeed::kMostRows);
  CHECK(delivery.dropped == 5);
}

TEST_CASE("frames from before are all noted, and judged where a monitor judges them again") {
  test::SampleBoard sample;
  UnitFeed feed(sample.unit);
  for (std::size_t k = 0; k < UnitFeed::kMostRows + 5; ++k)
    feed.on_recalled(test::frame_at(static_cast<int>(k), sample.unit.counts()), nullptr);
  const int next = static_cast<int>(UnitFeed::kMostRows) + 5;
  for (int k = 0; k < 100; ++k) {
    const Frame frame = test::frame_at(next + k, sample.unit.counts());
    sample.monitor.push(frame);
    feed.on_recalled(frame, &sample.monitor);
  }
  Delivery first, rest;
  feed.fetch(first);
  feed.offer();
  feed.fetch(rest);
  CHECK(first.rows.size() + rest.rows.size() == UnitFeed::kMostRows + 105);
  CHECK(rest.dropped == 0);
  CHECK(rest.rows[UnitFeed::kMostRows].judged == 0);
  CHECK(rest.judged.size() > 80);
  CHECK(rest.rows.back().judged == rest.judged.size());
}

}  // namespace
}  // namespace mpm::http
