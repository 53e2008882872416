#include "core/monitor/unit_reader.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/core/channel_model.hpp"

namespace mpm::unit_reader_test {
namespace {

double moves(std::int64_t interval) {
  const auto k = static_cast<double>(interval);
  return std::sin(0.13 * k) + 0.3 * std::sin(0.71 * k);
}

constexpr SignalCounts kCounts{1, 0, 1, 0};

struct Unit {
  Unit() : model(spec()), reader(model, kCounts, {true}, derive_settings(spec(), model, {}, {})) {}

  static ModelSpec spec() {
    return test::channel_model(1, 1, {{0, 0, TransferFunction{2.0, {4.0}, 0, 1, false}}});
  }
  /// Measured 0.25 above what the control system predicts; what comes out goes to `read`.
  void push(std::int64_t interval) {
    Frame frame(kCounts);
    for (SignalBlock& block : frame.blocks)
      std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
    frame.interval = interval;
    frame[SignalKind::kMv].values(0) = moves(interval);
    frame[SignalKind::kPrediction].values(0) = 3.0 * moves(interval);
    frame[SignalKind::kCv].values(0) = 3.0 * moves(interval) + 0.25;
    reader.push(frame);
    while (const Frame* out = reader.next()) {
      JudgedFrame judged;
      judged.readings.resize(1);
      reader.tell(*out, judged);
      read.push_back(judged);
      missing += reader.missing();
      turned += reader.turned().size();
    }
  }

  LinearModel model;
  UnitReader reader;
  std::vector<JudgedFrame> read;
  std::int64_t missing = 0;
  std::size_t turned = 0;
};

TEST_CASE("a reader tells the residual of each frame, once it has left the screen, over gaps too") {
  Unit unit;
  for (int k = 1; k <= 60; ++k) unit.push(k);
  for (int k = 68; k <= 100; ++k) unit.push(k);
  REQUIRE(unit.read.size() == 93 - Screen::kDelay);
  CHECK(unit.read.front().interval == 1);
  CHECK(unit.read.back().interval == 100 - Screen::kDelay);
  CHECK(unit.missing == 7);
  CHECK(unit.turned == 1);  // with the first prediction
  CHECK(unit.reader.samples() == static_cast<std::int64_t>(unit.read.size()));
  for (const JudgedFrame& judged : unit.read) {
    CHECK(judged.readings[0].residual == Approx(0.25).margin(1e-12));
    CHECK(judged.readings[0].measured == Approx(3.0 * moves(judged.interval) + 0.25));
  }
}

TEST_CASE("a reader that takes over a screen goes on with its frames, and has read none") {
  Unit first, second;
  for (int k = 1; k <= 30; ++k) first.push(k);
  second.reader.begin_with(first.reader.give_screen());
  second.push(31);
  CHECK(second.reader.samples() == 1);
  CHECK(second.missing == 0);
  REQUIRE(second.read.size() == 1);
  CHECK(second.read[0].interval == 31 - Screen::kDelay);
}

}  // namespace
}  // namespace mpm::unit_reader_test
