#include "daemon/http/unit_store.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

TEST_CASE("what a feed noted can be drawn, and readings find the rows that they are of") {
  test::SampleBoard sample;
  const UnitStore& store = sample.store();
  sample.push(60);
  sample.push(40);
  REQUIRE(store.extent());
  CHECK(store.extent()->first == 60'000'000'000);
  CHECK(store.extent()->second == 6'000'000'000'000);
  CHECK(store.latest(store.columns().measured(0)) == 100.0);
  CHECK(store.latest(store.columns().input(0)) == 1000.0);
  // No prediction came: the monitor's own is there a few frames later.
  CHECK(std::isnan(store.latest(store.columns().prediction(0))));
  const Drawing drawing =
      store.draw(0, 6'000'000'000'000, 1000,
                 {store.columns().measured(0), store.columns().prediction(0), store.residual(0)});
  REQUIRE(drawing.times_s.size() == 100);
  const std::size_t k = 50;
  CHECK(drawing.reaches[0][k].mean == 51.0F);
  CHECK(drawing.reaches[2][k].mean ==
        Approx(drawing.reaches[0][k].mean - drawing.reaches[1][k].mean));
  CHECK(store.band(0).samples == 0);  // nothing is known to match yet
}

TEST_CASE("snapshots are counted, and the last one is there for all") {
  test::SampleBoard sample;
  CHECK(sample.store().snapshot()->id == 0);
  sample.show(true);
  CHECK(sample.store().snapshot()->id == 1);
  CHECK(sample.store().snapshot()->channels.size() == 6);
  const auto kept = sample.store().snapshot();
  sample.show(false);
  CHECK(sample.store().snapshot()->id == 2);
  CHECK(kept->id == 1);
  CHECK(sample.board.events().query({}).size() == 1);
}

TEST_CASE("the rate is measured over some seconds") {
  RecentEvents events;
  UnitStore store(test::whole_column(), events);
  Delivery delivery;
  const auto start = UnitStore::Clock::now();
  (void)store.absorb(delivery, start);
  delivery.rows.resize(40);
  delivery.values.resize(40U * static_cast<std::size_t>(store.columns().width()));
  for (std::size_t k = 0; k < 40; ++k)
    delivery.rows[k].time_ns = static_cast<std::int64_t>(k + 1) * 1'000'000'000;
  (void)store.absorb(delivery, start + std::chrono::seconds(4));
  CHECK(store.samples_per_second() == Approx(10.0));
}

TEST_CASE("accuracy is what the model gains over no prediction") {
  history::Digest digest;
  CHECK(std::isnan(model_accuracy(digest)));
  CHECK(std::isnan(determined_share(digest)));
  history::CvDigest good, bad;
  good.pairs = bad.pairs = 10;
  good.prediction_rms = 0.1;
  good.movement_rms = 0.5;
  bad.prediction_rms = 3.0;
  bad.movement_rms = 1.0;
  digest.cvs = {good, bad, history::CvDigest()};
  CHECK(model_accuracy(digest) == Approx(0.4));
  digest.channels.resize(4);
  digest.channels[0].verdict = "match";
  CHECK(determined_share(digest) == 0.25);
}

}  // namespace
}  // namespace mpm::http
