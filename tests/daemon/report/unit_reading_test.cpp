#include "daemon/report/unit_reading.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "config/load_unit.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::report {
namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

config::UnitConfig unit() {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: u\nsample_time: 2\nsignals: {mv: [u1, u2], cv: [y1, {tag: y2, prediction: p2}]}\n"
      "model: {channels: [{cv: y1, mv: u1, gain: 1, time_constants: [20], dead_time: 4}, "
      "{cv: y1, mv: u2, gain: -1, time_constants: [8]}, {cv: y2, mv: u2, gain: 2}]}\n",
      "u.yaml");
  REQUIRE(loaded.ok());
  return loaded.config;
}

// All that can happen to a signal on its way: gaps, values missing, frames late, a stretch that is
// absurd and stays, and predictions that come only later.
std::vector<Frame> frames(const config::UnitConfig& unit) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<Frame> all;
  Frame frame(unit.counts());
  for (SignalBlock& block : frame.blocks)
    std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
  for (int k = 0; k < 4000; ++k) {
    frame.interval += random() % 50 == 0 ? static_cast<std::int64_t>(random() % 30) : 1;
    frame.source_time_ns = 2'000'000'000 * frame.interval;
    for (SignalBlock& block : frame.blocks)
      for (double& value : block.values)
        value = random() % 40 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                   : normal(random) + (k > 2500 ? 1e9 : 0.0);
    if (k < 1000)
      frame[SignalKind::kPrediction].values(1) = std::numeric_limits<double>::quiet_NaN();
    all.push_back(frame);
  }
  return all;
}

// The monitor itself says what it reads.
TEST_CASE("what is read without judging is what the monitor reads") {
  const config::UnitConfig config = unit();
  UnitMonitor monitor(config);
  UnitReading reading(config);
  std::size_t read = 0, known = 0, differing = 0;
  for (const Frame& frame : frames(config)) {
    monitor.push(frame);
    const std::span<const JudgedFrame> judged = monitor.monitor().judged();
    const std::span<const JudgedFrame> as_read = reading.push(frame);
    REQUIRE(as_read.size() == judged.size());
    for (std::size_t i = 0; i < judged.size(); ++i, ++read) {
      REQUIRE(as_read[i].interval == judged[i].interval);
      for (std::size_t j = 0; j < judged[i].readings.size(); ++j) {
        const CvReading &one = as_read[i].readings[j], &other = judged[i].readings[j];
        known += std::isfinite(one.residual) ? 1 : 0;
        differing +=
            same(one.measured, other.measured) && same(one.residual, other.residual) ? 0 : 1;
      }
    }
  }
  CHECK(differing == 0);
  CHECK(read > 3800);
  CHECK(known > 2000);
}

}  // namespace
}  // namespace mpm::report
