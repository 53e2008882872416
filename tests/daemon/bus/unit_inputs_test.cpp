#include "daemon/bus/unit_inputs.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <optional>

#include "config/load_unit.hpp"
#include "idl/layout_sample.hpp"

namespace mpm::bus::unit_inputs_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::uint64_t kGateway = 7, kOtherGateway = 8;

/// A unit with one MV, one DV and two CVs, one sample a second, that a hand-moved clock drives.
struct Scene {
  Scene() {
    ExpectedInputs expected;
    expected.unit = "toy";
    expected.counts = {1, 1, 2, 0};
    for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv})
      expected.needed[static_cast<std::size_t>(kind)] = true;
    inputs.emplace(expected, now);
    idl::DomainOptions domain;
    domain.domain = 3;
    domain.partition = "plant-a";
    around.place = place_text(domain);
    for (const char* topic : {"mpm/mv", "mpm/cv"}) add_writer(topic, kGateway, "gateway");
  }

  void add_writer(const char* topic, std::uint64_t handle, const char* program,
                  std::vector<std::string> mismatch = {}) {
    around.endpoints.push_back(
        {topic, "mpm::Sample", true, handle, {"plant1", program, "12"}, std::move(mismatch)});
  }
  void send(SignalKind kind, std::int64_t interval, std::uint64_t writer = kGateway) {
    const auto count = static_cast<std::size_t>(inputs->expected().counts.of(kind));
    inputs->push(kind, {writer, interval, start_ns + interval * kSecond, count, 0}, now);
  }
  /// One second of `kinds`.
  void second(std::initializer_list<SignalKind> kinds, std::int64_t interval) {
    for (const SignalKind kind : kinds) send(kind, interval);
    now += seconds(1);
  }
  [[nodiscard]] std::vector<Trouble> troubles() const { return inputs->troubles(around, now); }
  [[nodiscard]] std::string text() const { return joined_text(troubles(), 99); }

  InputStream::Clock::time_point now{seconds(1000)};
  std::int64_t start_ns = 1'700'000'000 * kSecond;
  std::optional<UnitInputs> inputs;
  Surroundings around;
};

constexpr auto kMv = SignalKind::kMv, kDv = SignalKind::kDv, kCv = SignalKind::kCv;

}  // namespace

TEST_CASE("a unit whose samples all come has no trouble") {
  Scene scene;
  for (int k = 0; k < 100; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().empty());
  CHECK_FALSE(scene.inputs->wants_endpoints(scene.now));
}

TEST_CASE("a topic that never comes is named, with who should write it") {
  Scene scene;
  for (int k = 0; k < 6; ++k) scene.second({kMv, kCv}, k);
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text() == "nothing on mpm/dv (nobody writes it on domain 3, partition 'plant-a')");
  CHECK(scene.inputs->wants_endpoints(scene.now));

  scene.add_writer("mpm/dv", kGateway, "gateway");
  CHECK(scene.text() ==
        "nothing on mpm/dv (gateway (process 12 on host plant1) has not written it for 6 s: "
        "stopped, or killed)");
  scene.around.strangers = {{"tyo", 99}};
  CHECK(scene.text() == "nothing on mpm/dv (samples come of unit 'tyo' only)");
  scene.around.strangers.clear();
  scene.around.endpoints.back().mismatch = {
      "RELIABILITY (best effort offered, reliable requested)"};
  CHECK(scene.text() ==
        "nothing on mpm/dv (its writer gateway (process 12 on host plant1) does not match: "
        "RELIABILITY (best effort offered, reliable requested))");
}

TEST_CASE("predictions that never come are simulated") {
  Scene scene;
  ExpectedInputs expected = scene.inputs->expected();
  expected.needed[static_cast<std::size_t>(SignalKind::kPrediction)] = true;
  scene.inputs->expect(expected);
  for (int k = 0; k < 6; ++k) scene.second({kMv, kDv, kCv}, k);
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text() ==
        "nothing on mpm/prediction (nobody writes it on domain 3, partition 'plant-a'): the unit "
        "file's model predicts");
}

TEST_CASE("a topic that stops is told with the time since, and no sooner than its silence") {
  Scene scene;
  for (int k = 0; k < 20; ++k) scene.second({kMv, kDv, kCv}, k);
  for (int k = 20; k < 24; ++k) scene.second({kMv, kCv}, k);
  CHECK(scene.text().find("mpm/dv for 5 s") != std::string::npos);  // sent at 19, it is 24 now
  CHECK(scene.text().find("nobody writes it") != std::string::npos);
  scene.add_writer("mpm/dv", kOtherGateway, "other");
  CHECK(scene.text().find("other (process 12 on host plant1) has not written it for ") !=
        std::string::npos);
  scene.add_writer("mpm/dv", kGateway, "gateway");
  CHECK(scene.text() ==
        "nothing on mpm/dv for 5 s (gateway (process 12 on host plant1) has stopped writing it, or "
        "was killed)");
  scene.now -= milliseconds(1);
  CHECK(scene.text().empty());
}

TEST_CASE("a unit of which nothing comes says where it listens and whose samples come instead") {
  Scene scene;
  scene.around.endpoints.clear();
  scene.now += seconds(5);
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kFunctionCheck);
  CHECK(scene.text() ==
        "no data has come (mpm/mv ...: nobody writes it on domain 3, partition 'plant-a')");
  for (const char* topic : {"mpm/mv", "mpm/dv", "mpm/cv"})
    scene.add_writer(topic, kGateway, "gateway");
  scene.around.strangers = {{"Toy", 99}};
  CHECK(scene.text() == "no data has come (mpm/mv ...: samples come of unit 'Toy' only)");
}

TEST_CASE("topics that leave out intervals are named with the share, until they are whole again") {
  Scene scene;
  for (int k = 0; k < 20; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.second({kMv, kCv}, 20);
  CHECK(scene.text().empty());
  for (int k = 21; k < 100; ++k) {
    if (k % 2 == 1)
      scene.second({kMv, kDv, kCv}, k);
    else
      scene.second({kMv, kCv}, k);
  }
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text() == "intervals are missing: 32 of the last 64 on mpm/dv");
  for (int k = 100; k < 155; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text() == "intervals are missing: 4 of the last 64 on mpm/dv");
  for (int k = 155; k < 157; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().empty());

  // A late one is not missing, and two gateways that share the intervals leave none out.
  Scene shared;
  for (int k = 0; k < 100; ++k) {
    if (k >= 5) shared.send(kMv, k - 5, k % 2 == 0 ? kGateway : kOtherGateway);
    shared.second({kDv, kCv}, k);
  }
  CHECK(shared.text().find("missing") == std::string::npos);
}

TEST_CASE("at a slow sample time a few samples tell that every second one is missing") {
  Scene scene;
  ExpectedInputs expected = scene.inputs->expected();
  expected.sample_time_s = 40.0;
  expected.silence = seconds(400);
  scene.inputs.emplace(expected, scene.now);
  for (int k = 0; k < 5; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv})
      if (kind != kCv || k % 2 == 0)
        scene.inputs->push(kind, {kGateway, k, 40 * k * kSecond, kind == kCv ? 2u : 1u, 0},
                           scene.now);
    scene.now += seconds(40);
  }
  CHECK(scene.text() == "intervals are missing: 2 of the last 5 on mpm/cv");
}

TEST_CASE("samples at another pace than the unit file's are told by their source times") {
  Scene scene;
  const auto at = [&](double period_s, int first, int last, std::int64_t from_ns) {
    for (int k = first; k < last; ++k) {
      for (const SignalKind kind : {kMv, kDv, kCv})
        scene.inputs->push(kind,
                           {kGateway, k, from_ns + static_cast<std::int64_t>(1e9 * period_s * k),
                            kind == kCv ? 2u : 1u, 0},
                           scene.now);
      scene.now += milliseconds(100);
    }
  };
  at(1.0, 0, 50, 0);  // a replay at ten times the speed
  CHECK(scene.text().empty());
  at(0.1, 50, 110, 45 * kSecond);
  CHECK(scene.text() ==
        "the source times on mpm/mv, mpm/dv, mpm/cv go on by 0.1 s an interval where the unit file "
        "has 1 s");
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);

  // Times of whole seconds at ten samples a second are only coarse.
  Scene coarse;
  ExpectedInputs expected = coarse.inputs->expected();
  expected.sample_time_s = 0.1;
  coarse.inputs.emplace(expected, coarse.now);
  for (int k = 0; k < 300; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv})
      coarse.inputs->push(kind, {kGateway, k, k / 10 * kSecond, kind == kCv ? 2u : 1u, 0},
                          coarse.now);
    coarse.now += milliseconds(100);
  }
  CHECK(coarse.text().empty());
}

TEST_CASE("a stall of a minute is one failure") {
  Scene scene;
  for (int k = 0; k < 20; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.now += seconds(59);
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kFailure);
  CHECK(scene.text().find("no data for 60 s") == 0);
}

TEST_CASE("two gateways: with the same numbers a remark, with others a failure") {
  Scene scene;
  scene.add_writer("mpm/mv", kOtherGateway, "spare");
  const bool same = GENERATE(true, false);
  for (int k = 0; k < 20; ++k) {
    scene.send(kMv, same ? k : 5000 + k, kOtherGateway);
    scene.second({kMv, kDv, kCv}, k);
  }
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity ==
        (same ? Severity::kMaintenanceRequired : Severity::kFailure));
  CHECK(
      scene.text().find("two gateways write mpm/mv: spare (process 12 on host plant1) and gateway "
                        "(process 12 on host plant1)") == 0);
  if (!same) CHECK(scene.text().find("(5019, 19)") != std::string::npos);
}

TEST_CASE("of two gateways with the same numbers one leaves and no failure is told") {
  Scene scene;
  ExpectedInputs expected = scene.inputs->expected();
  expected.sample_time_s = 0.1;
  scene.inputs.emplace(expected, scene.now);
  for (int k = 0; k < 200; ++k) {
    for (const std::uint64_t writer : {kGateway, kOtherGateway})
      for (const SignalKind kind : {kMv, kDv, kCv})
        if (k < 100 || writer == kGateway)
          scene.inputs->push(kind, {writer, k, k * (kSecond / 10), kind == kCv ? 2u : 1u, 0},
                             scene.now);
    scene.now += milliseconds(100);
    for (const Trouble& trouble : scene.troubles())
      CHECK(trouble.severity == Severity::kMaintenanceRequired);
  }
  CHECK(scene.text().empty());
}

TEST_CASE("a gateway that takes over from another one is not two") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  for (int k = 10; k < 20; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv}) scene.send(kind, k, kOtherGateway);
    scene.now += seconds(1);
    CHECK(scene.text().empty());
  }
}

TEST_CASE("a jump of the interval number is told for a minute") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.start_ns -= 5000 * kSecond;  // the clock goes on as if nothing had been
  for (int k = 5010; k < 5012; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().find("the interval number went from 9 to 5010 on mpm/mv, mpm/dv, mpm/cv") ==
        0);
  for (int k = 5012; k < 5069; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK_FALSE(scene.text().empty());
  for (int k = 5069; k < 5071; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().empty());
}

TEST_CASE("what came while this process stood still is nobody else's fault") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.now += seconds(30);
  CHECK_FALSE(scene.text().empty());
  scene.inputs->stood_still(scene.now);
  CHECK(scene.text().empty());
  for (int k = 40; k < 42; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().empty());
  for (int k = 42; k < 50; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.second({kMv, kDv, kCv}, 80);
  CHECK(scene.text() == "no intervals came between 49 and 80 on mpm/mv, mpm/dv, mpm/cv");
  CHECK(scene.troubles()[0].until_ns == scene.start_ns + 80 * kSecond);
}

TEST_CASE("of several leaps each names the topics that truly leapt") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  for (int k = 10; k < 25; ++k) scene.second({kMv, kCv}, k);  // DVs pause
  for (int k = 25; k < 30; ++k) scene.second({kMv, kDv, kCv}, k);
  CHECK(scene.text().find("no intervals came between 9 and 25 on mpm/dv") != std::string::npos);
  scene.now += seconds(20);
  for (int k = 50; k < 52; ++k) scene.second({kMv, kCv}, k);
  CHECK(scene.text().find("no intervals came between 9 and 25 on mpm/dv") != std::string::npos);
  CHECK(scene.text().find("no intervals came between 29 and 50 on mpm/mv, mpm/cv") !=
        std::string::npos);
  int jumps = 0;
  for (const Trouble& trouble : scene.troubles()) jumps += trouble.event.empty() ? 0 : 1;
  CHECK(jumps == 2);
}

TEST_CASE("a gateway that comes back with later numbers leaps as one that never left") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.now += seconds(2);
  scene.start_ns -= 90'000 * kSecond;
  for (int k = 90'012; k < 90'014; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv}) scene.send(kind, k, kOtherGateway);
    scene.now += seconds(1);
  }
  CHECK(scene.text() == "the interval number went from 9 to 90012 on mpm/mv, mpm/dv, mpm/cv");
}

TEST_CASE("of two gateways the one that has left is not counted") {
  Scene scene;
  scene.add_writer("mpm/mv", kOtherGateway, "spare");
  for (int k = 0; k < 20; ++k) {
    scene.send(kMv, 5000 + k, kOtherGateway);
    scene.second({kMv, kDv, kCv}, k);
  }
  CHECK(scene.text().find("two gateways write mpm/mv") == 0);
  scene.around.endpoints.pop_back();
  scene.second({kMv, kDv, kCv}, 20);
  CHECK(scene.text().empty());
}

TEST_CASE("interval numbers beyond 2^53 are a failure with that reason, and no other") {
  Scene scene;
  const std::int64_t last = std::int64_t{1} << 53;
  scene.start_ns = 0;
  std::int64_t time_ns = 0;
  const auto second = [&](std::int64_t k) {
    time_ns += kSecond;
    for (const SignalKind kind : {kMv, kDv, kCv})
      scene.inputs->push(kind, {kGateway, k, time_ns, kind == kCv ? 2u : 1u, 0}, scene.now);
    scene.now += seconds(1);
  };
  for (int i = -70; i <= 0; ++i) second(last + i);
  CHECK(scene.text().empty());
  for (int i = 1; i < 80; ++i) {
    second(i < 40 ? last + i : std::numeric_limits<std::int64_t>::max());
    REQUIRE(scene.troubles().size() == 1);
    CHECK(scene.troubles()[0].severity == Severity::kFailure);
  }
  CHECK(scene.text() ==
        "interval numbers beyond 2^53 are not taken: mpm/mv, mpm/dv, mpm/cv are at "
        "9223372036854775807");
}

TEST_CASE("a clock that steps by an hour is told, whatever time it shows") {
  Scene scene;
  const std::int64_t step_s = GENERATE(3600, -3600);
  scene.start_ns = GENERATE(std::int64_t{0}, 1'700'000'000 * kSecond);
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.start_ns += step_s * kSecond;
  scene.second({kMv, kDv, kCv}, 10);
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text() == std::string("the clock of the control system stepped ") +
                            (step_s > 0 ? "forward" : "back") +
                            " by 3600 s at interval 10 on mpm/mv, mpm/dv, mpm/cv");
}

TEST_CASE("a clock that runs as this machine's and shows another time is told for its process") {
  const double speed = GENERATE(1.0, 1.2);  // another one: what is replayed or simulated
  const std::int64_t off_s = GENERATE(-88'845, -50, -1'700'000'000);  // the last: simulated
  Scene scene;
  for (int k = 0; k < 30; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv}) {
      const auto count = static_cast<std::size_t>(scene.inputs->expected().counts.of(kind));
      const std::int64_t wall_ns = 1'700'000'000 * kSecond + k * kSecond;
      scene.inputs->push(
          kind,
          {kGateway, k,
           wall_ns + off_s * kSecond + static_cast<std::int64_t>((speed - 1.0) * k * kSecond),
           count, 0, wall_ns},
          scene.now);
    }
    scene.now += seconds(1);
  }
  if (speed > 1.0 || off_s != -88'845) {
    CHECK(scene.text().empty());
    return;
  }
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kMaintenanceRequired);
  CHECK(scene.text() ==
        "the source times of gateway (process 12 on host plant1) are 88845 s behind this machine's "
        "clock");
  CHECK(scene.inputs->wants_endpoints(scene.now));
}

TEST_CASE("of a clock that is off nothing is told of a writer that has left") {
  Scene scene;
  scene.add_writer("mpm/dv", kOtherGateway, "gateway");
  for (int k = 0; k < 30; ++k) {
    for (const SignalKind kind : {kMv, kDv, kCv}) {
      const auto count = static_cast<std::size_t>(scene.inputs->expected().counts.of(kind));
      const std::int64_t wall_ns = (1'700'000'000 + k) * kSecond;
      scene.inputs->push(
          kind,
          {kind == kDv ? kOtherGateway : kGateway, k, wall_ns + 3600 * kSecond, count, 0, wall_ns},
          scene.now);
    }
    scene.now += seconds(1);
  }
  const std::string told =
      "the source times of gateway (process 12 on host plant1) are 3600 s ahead of this machine's "
      "clock";
  CHECK(scene.text() == told);
  scene.around.endpoints.pop_back();  // it goes, one topic after the other
  CHECK(scene.text() == told);
}

TEST_CASE("a gateway that writes on under another name is told from one that stopped") {
  Scene scene;
  scene.add_writer("mpm/dv", kGateway, "gateway");
  for (int k = 0; k < 6; ++k) scene.second({kMv, kDv, kCv}, k);
  scene.around.strangers = {{"toyy", kGateway}, {"other", 99}};
  scene.now += seconds(5);
  CHECK(scene.text() ==
        "no data for 6 s (mpm/mv ...: gateway (process 12 on host plant1) writes unit 'toyy', "
        "which no unit file describes, and not 'toy')");
}

TEST_CASE("a wrong layout is that of its writer, until it is put right or has left") {
  Scene scene;
  config::LoadResult loaded = config::load_unit_text(
      "unit: toy\nsample_time: 1\nsignals: {mv: [u], cv: [y, z]}\n"
      "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [5]}]}\n",
      "toy.yaml");
  REQUIRE(loaded.ok());
  ExpectedInputs expected = scene.inputs->expected();
  expected.file = loaded.config;
  expected.needed = {};
  scene.inputs->expect(expected);
  const std::string unit = "toy";
  const SignalLayout right{{"y", "z"}, {}}, wrong{{"z", "y"}, {}};
  const auto hear = [&](const SignalLayout& layout, std::uint64_t writer) {
    scene.inputs->hear(idl::LayoutSample(unit, "cv", 1.0, layout).get(), writer);
  };
  hear(right, kGateway);
  CHECK_FALSE(scene.inputs->wants_endpoints(scene.now));
  hear(wrong, kOtherGateway);
  hear(right, kGateway);        // another one's word changes nothing
  CHECK(scene.text().empty());  // it is not there
  CHECK(scene.inputs->wants_endpoints(scene.now));
  scene.add_writer("mpm/layout", kOtherGateway, "stranger");
  CHECK(scene.text() ==
        "layout differs from the unit file: cv (tags or their order) of stranger (process 12 on "
        "host plant1)");
  scene.around.endpoints.pop_back();
  CHECK(scene.text().empty());
  scene.add_writer("mpm/layout", kOtherGateway, "stranger");
  hear(right, kOtherGateway);
  CHECK(scene.text().empty());
  hear(wrong, kOtherGateway);
  scene.inputs->forget_layout("cv", kOtherGateway);
  CHECK(scene.text().empty());
}

TEST_CASE("samples that cannot become frames say why") {
  Scene scene;
  for (int k = 0; k < 10; ++k) scene.second({kMv, kDv, kCv}, k);
  SECTION("another number of values") {
    scene.inputs->push(kCv, {kGateway, 10, 0, 3, 0}, scene.now);
    CHECK(scene.text().find("mpm/cv has 3 values and 0 qualities where the unit file has 2 "
                            "signals") != std::string::npos);
  }
  SECTION("a counter that stands") {
    for (int i = 0; i < 10; ++i) {
      scene.send(kMv, 9);
      scene.second({kDv, kCv}, 10 + i);
    }
    CHECK(scene.text() == "mpm/mv repeats interval 9: the counter stands");
  }
  SECTION("counters of their own") {
    scene.inputs.emplace(scene.inputs->expected(), scene.now);
    for (int k = 0; k < 10; ++k) {
      scene.send(kCv, 1000 + k);
      scene.second({kMv, kDv}, k);
    }
    CHECK(scene.text() == "interval numbers do not meet: mpm/cv is at 1009, mpm/mv at 9");
  }
}

TEST_CASE("samples of another length that nobody waits for leave verdicts, in doubt") {
  Scene scene;
  ExpectedInputs expected = scene.inputs->expected();
  expected.needed[static_cast<std::size_t>(SignalKind::kPrediction)] = true;
  expected.welcome[static_cast<std::size_t>(SignalKind::kSetpoint)] = true;
  scene.inputs->expect(expected);
  const SignalKind kind = GENERATE(SignalKind::kPrediction, SignalKind::kSetpoint);
  for (int k = 0; k < 10; ++k) {
    scene.inputs->push(kind, {kGateway, k, k * kSecond, 3, 0}, scene.now);
    if (kind == SignalKind::kSetpoint) scene.send(SignalKind::kPrediction, k);
    scene.second({kMv, kDv, kCv}, k);
  }
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text().find(" has 3 values and 0 qualities where the unit file has 2 signals") !=
        std::string::npos);
}

TEST_CASE("set-points that came in each interval and have stopped are told, others are not") {
  constexpr auto kSetpoint = SignalKind::kSetpoint;
  Scene scene;
  ExpectedInputs expected = scene.inputs->expected();
  const bool welcome = GENERATE(true, false);
  expected.welcome[static_cast<std::size_t>(kSetpoint)] = welcome;
  scene.inputs->expect(expected);
  const int each = GENERATE(1, 2, 20);
  for (int k = 0; k < 200; ++k) {
    if (k % each == 0) scene.send(kSetpoint, k);
    scene.second({kMv, kDv, kCv}, k);
  }
  CHECK(scene.text().empty());
  for (int k = 200; k < 230; ++k) scene.second({kMv, kDv, kCv}, k);
  if (!welcome || each > 1) {
    CHECK(scene.text().empty());
    return;
  }
  REQUIRE(scene.troubles().size() == 1);
  CHECK(scene.troubles()[0].severity == Severity::kOutOfSpecification);
  CHECK(scene.text().find("nothing on mpm/setpoint for 31 s (") == 0);
  CHECK(scene.inputs->wants_endpoints(scene.now));
  scene.send(kSetpoint, 230);
  CHECK(scene.text().find("nothing on mpm/setpoint") == std::string::npos);
  scene.now += seconds(60);  // with all the others
  CHECK(scene.text().find("no data for 61 s") == 0);
  CHECK(scene.troubles().size() == 1);
}

TEST_CASE("any numbers from any number of writers are borne") {
  Scene scene;
  for (std::uint64_t writer = 0; writer < 1000; ++writer) {
    scene.inputs->push(kMv, {writer, std::numeric_limits<std::int64_t>::min(), 0, 1, 0}, scene.now);
    scene.inputs->push(kMv,
                       {writer, std::numeric_limits<std::int64_t>::max(),
                        std::numeric_limits<std::int64_t>::min(), 1, 0},
                       scene.now);
    scene.now += milliseconds(1);
  }
  CHECK(scene.troubles().size() < 10);
}

}  // namespace mpm::bus::unit_inputs_test
