#include "tests/soak/score.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "config/load_unit.hpp"
#include "daemon/history/alarm_store.hpp"
#include "tests/system/process.hpp"

namespace mpm::soak::score_test {
namespace {

history::AlarmEntry entry(std::int64_t time_s, const std::string& mv, const std::string& what) {
  history::AlarmEntry entry;
  entry.source_time_ns = 1'000'000'000 * time_s;
  entry.unit = "soak";
  entry.mv = mv;
  entry.cv = "y";
  entry.what = what;
  return entry;
}

constexpr std::int64_t kSecond = 1'000'000'000;

TEST_CASE("a wrong time without its alarm is missed, an alarm without one has no cause") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alarms.sqlite");
  history::AlarmStore store(path, history::AlarmStore::Access::kAppend);
  const std::vector<WrongTime> wrong = {{"u1", "y", 100 * kSecond, 200 * kSecond},
                                        {"u2", "y", 300 * kSecond, 400 * kSecond},
                                        {"u1", "y", 500 * kSecond, 600 * kSecond},
                                        {"u1", "y", 700 * kSecond, 800 * kSecond},
                                        {"u2", "y", 900 * kSecond, 900 * kSecond}};
  store.append({entry(150, "u1", "active"), entry(160, "u1", "acknowledged"),
                entry(220, "u1", "cleared"),   // the one of u2 at 300 is missed
                entry(470, "u2", "active"),    // too late: without a cause
                entry(650, "u1", "active"),    // the memory still held the third, which has it so
                entry(250, "u1", "active")});  // a late one of the first
  const AlarmScore result = score(path, wrong, 50.0, 60.0);
  CHECK(result.wrong_times == 4);
  CHECK(result.raised == 4);
  // u2 at 300. The fourth began while the alarm of u1 stood.
  CHECK(result.missed == 1);
  CHECK(result.wrong == std::vector<std::string>{"u2 -> y at 470 s"});
  CHECK(result.longest_delay_s == 150.0);
}

// By hand: two lines of slope 2, five apart.
TEST_CASE("the slope is that within each process") {
  Slope slope;
  for (int age = 0; age < 4; ++age) {
    slope.add(0, age, 10.0 + 2.0 * age);
    slope.add(1, 10.0 + age, 5.0 + 2.0 * age);
  }
  CHECK(slope.estimate().slope == Approx(2.0));
  CHECK(slope.estimate().error == Approx(0.0).margin(1e-12));
  Slope noisy;  // -1 1 1 -1 about a level: slope 0, residual 4, freedom 2, sum of squared ages 5
  for (int age = 0; age < 4; ++age) noisy.add(7, age, age == 0 || age == 3 ? -1.0 : 1.0);
  CHECK(noisy.estimate().slope == Approx(0.0).margin(1e-12));
  CHECK(noisy.estimate().error == Approx(std::sqrt(4.0 / 2.0 / 5.0)));
  Slope alike(3);  // each of these four, three times, and one of another process
  for (int i = 0; i < 12; ++i) alike.add(7, i / 3, i / 3 == 0 || i / 3 == 3 ? -1.0 : 1.0);
  alike.add(8, 5.0, 4.0);
  CHECK(alike.estimate().points == 5);
  CHECK(alike.estimate().error == Approx(std::sqrt(4.0 / 2.0 / 5.0)));
}

// The gain that the plant shows, by its answer in the long run.
TEST_CASE("the plant is the model, but for one channel in its wrong times") {
  const config::UnitConfig config =
      config::load_unit_text(
          "unit: t\nsample_time: 1\nsignals: {mv: [u], cv: [y]}\n"
          "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [3]}]}\n"
          "simulation: {noise: {sigma: 0, pole: 0}}\n",
          "t.yaml")
          .config;
  Plant plant(config, 1, 100, 50);
  LinearModel model(config.model);
  for (int k = 0; k < 300; ++k) {
    const Frame& frame = plant.next();
    const double ratio = k % 150 < 100 ? 1.0 : 1.5;
    CHECK(frame[SignalKind::kCv].values(0) == Approx(ratio * model.output()(0)).margin(1e-12));
    model.advance(frame[SignalKind::kMv].values);
  }
  REQUIRE(plant.wrong_times().size() == 2);
  CHECK(plant.wrong_times()[0].from_ns == 101 * kSecond);
  CHECK(plant.wrong_times()[0].until_ns == 151 * kSecond);
}

}  // namespace
}  // namespace mpm::soak::score_test
