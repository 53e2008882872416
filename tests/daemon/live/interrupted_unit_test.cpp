#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <set>

#include "config/load_unit.hpp"
#include "tests/daemon/live/interrupted_unit.hpp"

namespace mpm {
namespace {

constexpr int kDamages = 60;  // of each ordeal

config::UnitConfig plant(const std::string& name) {
  config::LoadResult loaded = config::load_unit(MPM_SOURCE_DIR "/config/plants/" + name + ".yaml");
  REQUIRE(loaded.ok());
  return loaded.config;
}

// Two inputs and a disturbance, calculated and auxiliary signals, and a memory that is short beside
// the run: it fills, fades, and begins anew. `monitor`: further settings.
config::UnitConfig small_unit(const std::string& monitor, const std::string& predictions) {
  const config::LoadResult loaded = config::load_unit_text(
      "unit: small\nsample_time: 1\n"
      "signals:\n"
      "  mv: [{tag: u1, low: -0.9, high: 0.9}, u2]\n"
      "  dv: [{tag: d1}]\n"
      "  cv: [{tag: y1, setpoint: s1" +
          std::string(predictions.empty() ? "" : ", prediction: p1") +
          "}, {tag: y2, setpoint: s2, prediction: p2}]\n"
          "  aux: [{tag: ambient}]\n"
          "  raw: [{tag: weight}]\n"
          "  calc: {s2: weight / 2}\n"
          "model:\n"
          "  channels:\n"
          "    - {cv: y1, mv: u1, gain: 2, time_constants: [6], dead_time: 2}\n"
          "    - {cv: y1, mv: u2, gain: -1, time_constants: [4], dead_time: 1}\n"
          "    - {cv: y1, mv: d1, numerator: [0.1], denominator: [1, -0.9], delay_samples: 3}\n"
          "    - {cv: y2, mv: u1, gain: 0.5, time_constants: [5]}\n"
          "    - {cv: y2, mv: u2, step_response: [0, 0.3, 0.8, 1.2, 1.4, 1.5]}\n"
          "monitor: {memory: 900, fast_memory: 300, fir_lags: 6, residual_order: 2, tail: 6, "
          "controlling_lags: 8, first_lag: -3, last_lag: 10" +
          monitor +
          "}\n"
          "alarms: {on_delay: 4, off_delay: 15, realarm: 200, controller: {off_delay: 40}}\n",
      "small.yaml");
  for (const auto& finding : loaded.findings) UNSCOPED_INFO(finding.message);
  REQUIRE(loaded.ok());
  return loaded.config;
}

std::vector<test::Ordeal> ordeals() {
  using test::Ordeal;
  std::vector<Ordeal> all;
  all.push_back(Ordeal{.name = "shell",
                       .config = plant("shell3x3"),
                       .samples = 1500,
                       .change_from = 900,
                       .change_until = 1200});
  all.push_back(Ordeal{.name = "wood_berry",
                       .config = plant("wood_berry"),
                       .samples = 900,
                       .predicted = false,
                       .troubles = true});
  all.push_back(Ordeal{.name = "tank",
                       .config = plant("integrating_tank"),
                       .samples = 900,
                       .first_prediction = 250,
                       .troubles = true});
  all.push_back(Ordeal{.name = "predictions that cease",
                       .config = small_unit("", "p"),
                       .samples = 2400,
                       .none_from = 500,
                       .none_until = 1500});
  all.push_back(Ordeal{.name = "changes",
                       .config = small_unit("", "p"),
                       .samples = 3000,
                       .change_from = 1100,
                       .change_until = 1900,
                       .rest_from = 2500,
                       .rest_until = 2800});
  all.push_back(Ordeal{.name = "simulated, kernel",
                       .config = small_unit(", nonlinear: kernel", ""),
                       .samples = 2600,
                       .seed = 2,
                       .change_from = 1500,
                       .change_until = 2100,
                       .troubles = true});
  all.push_back(Ordeal{.name = "bends, random features",
                       .config = small_unit(", nonlinear: random_features", "p"),
                       .samples = 2600,
                       .seed = 3,
                       .bend = 0.3,
                       .shuffled = true});
  all.push_back(
      Ordeal{.name = "bends and changes, sliding",
             .config = small_unit(", sliding_window: true, correlation: alternative", "p"),
             .samples = 2600,
             .seed = 4,
             .change_from = 1700,
             .change_until = 2300,
             .bend = 0.2,
             .rest_from = 40,
             .rest_until = 600});
  all.push_back(
      Ordeal{.name = "follows, mean line",
             .config = small_unit(", threshold: mean_line, correlation: conventional", "p"),
             .samples = 2200,
             .seed = 5,
             .change_from = 1500,
             .change_until = 2200,
             .follows = 0.3,
             .troubles = true,
             .quantum = 0.2});
  all.push_back(Ordeal{.name = "follows",
                       .config = small_unit("", "p"),
                       .samples = 1600,
                       .seed = 7,
                       .follows = 0.3});
  all.push_back(Ordeal{.name = "held, nonlinear off",
                       .config = small_unit(", nonlinear: off, correlation: partial", "p"),
                       .samples = 2400,
                       .seed = 6,
                       .first_prediction = 300,
                       .troubles = true,
                       .shuffled = true,
                       .held_until = 1400});
  return all;
}

// What the ordeals come by is counted, so that the test cannot come to test less.
TEST_CASE("a unit that was put away and made anew goes on as if it had not been") {
  std::set<Reason> reasons;
  std::set<NonlinearVerdict> nonlinear;
  int alarms = 0, bent = 0;
  std::uint64_t restarts = 0, implausible = 0;
  std::mt19937_64 random(20100601);
  for (const test::Ordeal& ordeal : ordeals()) {
    CAPTURE(ordeal.name);
    const std::vector<Frame> frames = frames_of(ordeal);
    test::OneUnit whole(ordeal.config);
    auto interrupted = std::make_unique<test::OneUnit>(ordeal.config);
    for (int k = 0; k < ordeal.samples; ++k) {
      if (random() % 40 == 0) {
        CAPTURE(k);
        const std::vector<std::byte> bytes = interrupted->put_away();
        const std::string before = interrupted->all();
        auto anew = std::make_unique<test::OneUnit>(ordeal.config);
        anew->take_back(bytes);
        REQUIRE((anew->put_away() == bytes));
        REQUIRE((anew->all() == before));
        REQUIRE((whole.all() == before));  // which correlates
        interrupted = std::move(anew);
      }
      whole.take(ordeal, frames, k);
      interrupted->take(ordeal, frames, k);
      if (whole.said() != interrupted->said()) FAIL("they part at sample " << k);
      for (int j = 0; j < ordeal.config.counts().cv; ++j)
        for (int i = 0; i < ordeal.config.counts().inputs(); ++i) {
          const ChannelStatus& channel = whole.monitor().monitor().channel(j, i);
          reasons.insert(channel.reason);
          bent += std::isfinite(channel.gain_variation) ? 1 : 0;
          nonlinear.insert(whole.monitor().monitor().nonlinearity(j, i).verdict);
        }
      alarms += static_cast<int>(whole.monitor().alarms().size());
    }
    CHECK((whole.all() == interrupted->all()));
    CHECK((whole.put_away() == interrupted->put_away()));
    restarts += whole.aligned().restarts;
    implausible += whole.monitor().counters().implausible.spikes +
                   whole.monitor().counters().implausible.frozen;
  }
  CHECK(alarms >= 5);
  CHECK(bent > 0);
  CHECK(restarts >= 2);
  CHECK(implausible > 20);
  CHECK(nonlinear.size() == 3);
  for (const Reason reason :
       {Reason::kNone, Reason::kWarmingUp, Reason::kNotExcited, Reason::kConfounded,
        Reason::kBadData, Reason::kCompressed, Reason::kControllerOff, Reason::kIsolating,
        Reason::kOperatingPoint}) {
    CAPTURE(to_string(reason));
    CHECK(reasons.contains(reason));
  }
}

// Where small whole numbers stand, as lengths, counts and places are; no double looks like one.
std::vector<std::size_t> whole_numbers(const std::vector<std::byte>& bytes) {
  std::vector<std::size_t> found;
  for (std::size_t at = 0; at + sizeof(std::uint64_t) <= bytes.size(); ++at) {
    std::uint64_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    if (number > 0 && number < 1U << 20U) found.push_back(at);
  }
  return found;
}

// Whatever bytes say, nothing is read or written where it should not be (the sanitizers look), and
// what was taken back goes on; what it says then is another matter.
TEST_CASE("damaged bytes are refused, or make a unit that works") {
  std::mt19937_64 random(7);
  for (const test::Ordeal& ordeal : ordeals()) {
    if (ordeal.config.unit != "small" || ordeal.seed % 2 != 0) continue;
    CAPTURE(ordeal.name);
    const std::vector<Frame> frames = frames_of(ordeal);
    const int until = ordeal.samples - 200;
    test::OneUnit unit(ordeal.config);
    for (int k = 0; k < until; ++k) unit.take(ordeal, frames, k);
    const std::vector<std::byte> bytes = unit.put_away();
    const std::vector<std::size_t> whole = whole_numbers(bytes);
    int refused = 0, worked = 0;
    const auto attempt = [&](const std::vector<std::byte>& damaged) {
      test::OneUnit anew(ordeal.config);
      try {
        anew.take_back(damaged);
      } catch (const std::runtime_error&) {
        ++refused;
        return;
      }
      ++worked;
      for (int k = until; k < until + 60; ++k) anew.take(ordeal, frames, k);
      CHECK_FALSE(anew.all().empty());
      CHECK(anew.put_away().size() > 1000);
    };
    for (int n = 0; n < kDamages; ++n) {
      std::vector<std::byte> damaged = bytes;
      const std::size_t at = n % 4 == 0 ? random() % bytes.size() : whole[random() % whole.size()];
      if (n % 3 == 0) {
        damaged[at] ^= std::byte{1} << (random() % 8);
      } else {  // where numbers may begin: as large, as small and as odd as they come
        constexpr std::array kOdd = {0x7fffffffffffffffULL,
                                     0xffffffffffffffffULL,
                                     0x8000000000000000ULL,
                                     0x7ff8000000000000ULL,
                                     0x7ff0000000000000ULL,
                                     0x100000000ULL,
                                     1ULL};
        const std::uint64_t odd = kOdd[random() % kOdd.size()];
        std::memcpy(damaged.data() + std::min(at, bytes.size() - sizeof odd), &odd, sizeof odd);
      }
      attempt(damaged);
    }
    CHECK(refused > 0);
    CHECK(worked > 0);
    for (int n = 0; n < 20; ++n) {
      const int before = refused;
      attempt(
          {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size())});
      CHECK(refused == before + 1);
    }
  }
}

TEST_CASE("another configuration's bytes are refused") {
  const std::vector<std::byte> bytes = test::OneUnit(plant("shell3x3")).put_away();
  test::OneUnit other(plant("wood_berry"));
  CHECK_THROWS_AS(other.take_back(bytes), std::runtime_error);
}

}  // namespace
}  // namespace mpm
