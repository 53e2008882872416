#include "daemon/files/input_ranges.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "config/load_unit.hpp"

namespace mpm::files::input_ranges_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

config::UnitConfig unit() {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: u\nsample_time: 10\nsignals:\n"
      "  mv: [{tag: valve, low: 0, high: 100}, {tag: open, low: 0}, {tag: simulated}]\n"
      "  dv: [{tag: feed, low: 20, high: 30}]\n  cv: [{tag: y, low: 1, high: 2}]\n"
      "simulation: {limits: {simulated: {low: -1, high: 1}}}\n",
      "u.yaml", config::ModelNeed::kMayBeMissing);
  REQUIRE(loaded.ok());
  return loaded.config;
}

Quality judged(SignalKind kind, int index, double value, Quality given = Quality::kGood,
               Purpose purpose = Purpose::kJudge) {
  const config::UnitConfig config = unit();
  Frame frame(config.counts());
  frame[kind].values(index) = value;
  Quality& quality = frame[kind].quality[static_cast<std::size_t>(index)];
  quality = given;
  InputRanges(config, purpose).mark(frame);
  return quality;
}

// Eight times 100 below 0 and above 100; of 10, 20 and 30.
TEST_CASE("what lies far outside the limits of an input is no value of it") {
  CHECK(judged(SignalKind::kMv, 0, -9999.0) == Quality::kImplausible);
  CHECK(judged(SignalKind::kMv, 0, -801.0) == Quality::kImplausible);
  CHECK(judged(SignalKind::kMv, 0, 901.0) == Quality::kImplausible);
  CHECK(judged(SignalKind::kMv, 0, 901.0, Quality::kUncertain) == Quality::kImplausible);
  CHECK(judged(SignalKind::kMv, 2, 18.0) == Quality::kImplausible);
  CHECK(judged(SignalKind::kDv, 0, -61.0) == Quality::kImplausible);
}

TEST_CASE("what is outside by no more than limits are moved stays as it is") {
  CHECK(judged(SignalKind::kMv, 0, -799.0) == Quality::kGood);
  CHECK(judged(SignalKind::kMv, 0, 110.0, Quality::kUncertain) == Quality::kUncertain);
  CHECK(judged(SignalKind::kDv, 0, 0.0) == Quality::kGood);
  CHECK(judged(SignalKind::kMv, 0, kNan, Quality::kBad) == Quality::kBad);
}

TEST_CASE("one limit alone, or a CV's soft ones, say nothing of what a value can be") {
  CHECK(judged(SignalKind::kMv, 1, -1e9) == Quality::kGood);
  CHECK(judged(SignalKind::kCv, 0, 1e9) == Quality::kGood);
}

TEST_CASE("who keeps the values keeps all of them") {
  CHECK(judged(SignalKind::kMv, 0, -9999.0, Quality::kGood, Purpose::kKeep) == Quality::kGood);
}

}  // namespace
}  // namespace mpm::files::input_ranges_test
