#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "config/load_unit.hpp"
#include "daemon/bag/open_recording.hpp"
#include "tests/daemon/bag/bench.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::detect_test {
namespace {

/// Rows of the small unit, a minute apart.
std::string rows(int count) {
  std::string text = "time,u,\"d,1\",y,z,yhat,sp\n";
  for (int k = 0; k < count; ++k)
    text += std::to_string(60 * k) + "," + std::to_string(0.1 * k) + ",1," +
            std::to_string(0.3 * k) + "," + std::to_string(0.7 * k) + ",1.5,2\n";
  return text;
}

int mpm(const Bench& bench, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "mpm");
  return run(arguments, bench.folder.file("out"), bench.folder.file("err")).value_or(-1);
}

int detect(const Bench& bench, const std::string& data, std::vector<std::string> options = {}) {
  std::vector<std::string> arguments = {"detect", "--config", bench.folder.file("small.yaml"),
                                        "--data", bench.folder.file(data)};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return mpm(bench, arguments);
}

TEST_CASE("mpm detect says the same of a few rows, whatever file holds them") {
  Bench bench;
  const int count = GENERATE(1, 7, 8, 9, 12);
  write_file(bench.folder.file("a.csv"), rows(count));
  static_cast<void>(bench.convert("a.csv", "a.mcap", bench.with_unit()));
  REQUIRE(detect(bench, "a.csv",
                 {"--json", "--journal-every-sample", bench.folder.file("csv.jsonl")}) == 0);
  const std::string csv = bench.text("out");
  REQUIRE(detect(bench, "a.mcap",
                 {"--json", "--journal-every-sample", bench.folder.file("mcap.jsonl")}) == 0);
  CHECK(bench.text("out") == csv);
  CHECK(bench.text("mcap.jsonl") == bench.text("csv.jsonl"));
  const auto json = nlohmann::json::parse(csv);
  CHECK(json["samples"] == count);
  for (const auto& channel : json["channels"]) {
    CHECK(channel["verdict"] == "undetermined");
    CHECK(channel["reason"] == "warming_up");
  }
}

TEST_CASE("how much of a file has been read grows to all of it") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), rows(500));
  static_cast<void>(bench.convert("a.csv", "a.mcap", bench.with_unit()));
  const std::string name = GENERATE("a.csv", "a.mcap");
  const config::LoadResult unit = config::load_unit(bench.folder.file("small.yaml"));
  const auto frames = bag::open_recording(bench.folder.file(name), unit.config);
  Frame frame(unit.config.counts());
  double share = 0.0;
  int parts = 0;
  while (frames->next(frame)) {
    CHECK(frames->share_read() >= share);
    if (frames->share_read() > share) ++parts;
    share = frames->share_read();
  }
  CHECK(share == 1.0);
  CHECK(parts > 100);
}

TEST_CASE("mpm detect takes a recording without one control interval for bad input") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), rows(20));
  static_cast<void>(bench.convert("a.csv", "a.mcap", bench.with_unit()));
  // No sample of the recording fits a unit that is wider in every kind.
  write_file(bench.folder.file("small.yaml"),
             "unit: small\nsample_time: 60\n"
             "signals: {mv: [u, v], dv: ['d,1', e], cv: [{tag: y, prediction: yhat}, z, w]}\n"
             "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [480]}]}\n");
  CHECK(detect(bench, "a.mcap") == 3);
  CHECK(bench.text("out").empty());
  CHECK(bench.text("err").find("a.mcap: error: holds no control interval of unit 'small'") !=
        std::string::npos);
}

TEST_CASE("Exports in local times are read by every command that reads data") {
  Bench bench;
  write_file(bench.folder.file("l.csv"),
             "time;u;d,1;y;z\n31.03.2024 01:59:00;1;1;2;3\n31.03.2024 03:00:00;2;1;2;3\n");
  CHECK(detect(bench, "l.csv") == 3);
  CHECK(lines_of(bench.text("err"))
            .back()
            .find("l.csv:2:1: error: '31.03.2024 01:59:00' is a local "
                  "time: ") != std::string::npos);
  CHECK(bench.text("err").find("--time-zone") != std::string::npos);
  CHECK(detect(bench, "l.csv", {"--time-zone", "Europe/Berlin", "--json"}) == 0);
  const auto json = nlohmann::json::parse(bench.text("out"));
  CHECK(json["samples"] == 2);
  CHECK(json["missing_samples"] == 0);
  CHECK(bench.text("err").find("l.csv: times without a zone are read as those of Europe/Berlin") !=
        std::string::npos);
  CHECK(detect(bench, "l.csv", {"--time-zone", "Mars/Base"}) == 3);

  CHECK(mpm(bench, {"info", bench.folder.file("l.csv")}) == 3);
  CHECK(bench.text("err").find("--time-zone") != std::string::npos);
  CHECK(mpm(bench, {"info", bench.folder.file("l.csv"), "--time-zone", "Europe/Berlin"}) == 0);
  CHECK(bench.text("out").find("2024-03-31T00:59:00Z to 2024-03-31T01:00:00Z") !=
        std::string::npos);
  const std::string unit = bench.folder.file("small.yaml");
  CHECK(mpm(bench, {"diagnose", "--config", unit, "--data", bench.folder.file("l.csv"), "--out",
                    bench.folder.file("d"), "--time-zone", "Europe/Berlin"}) == 3);
  CHECK(bench.text("err").find("too short: 2 usable samples") != std::string::npos);
}

TEST_CASE("Every command that reads data takes --time-zone and --time-format") {
  Bench bench;
  for (const char* command : {"detect", "diagnose", "convert", "info", "publish"}) {
    CAPTURE(command);
    CHECK(mpm(bench, {command, "--help"}) == 0);
    CHECK(bench.text("out").find("--time-zone") != std::string::npos);
    CHECK(bench.text("out").find("--time-format") != std::string::npos);
  }
  // Written as nobody else does: 2024-03-03 and 04, 23:59 and midnight.
  write_file(bench.folder.file("o.csv"),
             "time;u;d,1;y;z\n03032024-2359;1;1;2;3\n04032024-0000;2;1;2;3\n");
  CHECK(detect(bench, "o.csv", {"--time-zone", "UTC"}) == 3);
  CHECK(bench.text("err").find("--time-format") != std::string::npos);
  const std::vector<std::string> said = {"--time-zone", "UTC", "--time-format", "%d%m%Y-%H%M"};
  CHECK(detect(bench, "o.csv", {"--json", said[0], said[1], said[2], said[3]}) == 0);
  CHECK(nlohmann::json::parse(bench.text("out"))["samples"] == 2);
  CHECK(mpm(bench, {"info", bench.folder.file("o.csv"), said[0], said[1], said[2], said[3]}) == 0);
  CHECK(bench.text("out").find("2024-03-03T23:59:00Z to 2024-03-04T00:00:00Z") !=
        std::string::npos);
  CHECK(mpm(bench, {"convert", bench.folder.file("o.csv"), bench.folder.file("p.csv"), said[0],
                    said[1], said[2], said[3]}) == 0);
  CHECK(bench.text("p.csv").find("2024-03-04T00:00:00Z,2,1,2,3") != std::string::npos);
  CHECK(mpm(bench, {"diagnose", "--config", bench.folder.file("small.yaml"), "--data",
                    bench.folder.file("o.csv"), "--out", bench.folder.file("d"), said[0], said[1],
                    said[2], said[3]}) == 3);
  CHECK(bench.text("err").find("too short: 2 usable samples") != std::string::npos);
  CHECK(detect(bench, "o.csv", {said[0], said[1], "--time-format", ""}) == 3);
  CHECK(bench.text("err").find("--time-format") != std::string::npos);
  CHECK(bench.text("err").find("is empty") != std::string::npos);
  CHECK(detect(bench, "o.csv", {said[0], said[1], "--time-format", "dd.mm.yyyy"}) == 3);
  CHECK(bench.text("err").find("--time-format: error: 'dd.mm.yyyy' does not tell") !=
        std::string::npos);
}

// The plant's exact answer at 1 s to an input that a controller moves every 10 s: for an input held
// through a row, y(t + 1) = a y(t) + (1 - a) 2 u(t - 15), a = exp(-1 / 60).
TEST_CASE("data faster than the sample time are averaged, and no dead time comes of it") {
  Bench bench;
  const double factor = std::exp(-1.0 / 60.0);
  const int phase = GENERATE(0, 5);  // of the file's first row after a move of the controller
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::string text = "time,u,y\n";
  double y = 0.0, drift = 0.0;
  std::vector<double> u;
  for (int t = 0; t < 30'000; ++t) {
    const int interval = t / 10;
    u.push_back(t % 10 == 0 ? (interval % 3 == 0 ? (random() % 2 == 0 ? 1.0 : -1.0) : u.back())
                            : u.back());
    drift = 0.99 * drift + 0.01 * normal(random);
    if (t >= phase)
      text += std::to_string(t) + ',' + std::to_string(u.back()) + ',' +
              std::to_string(y + drift + 0.05 * normal(random)) + '\n';
    y = factor * y + (1.0 - factor) * 2.0 * (t >= 15 ? u[static_cast<std::size_t>(t - 15)] : 0.0);
  }
  write_file(bench.folder.file("fast.csv"), text);
  const auto verdict = [&](const std::string& dead_time, const std::string& gain) {
    write_file(bench.folder.file("small.yaml"),
               "unit: small\nsample_time: 10\nsignals: {mv: u, cv: y}\nmodel: {channels: [{cv: y, "
               "mv: u, gain: " +
                   gain + ", time_constants: [60], dead_time: " + dead_time + "}]}\n");
    REQUIRE(detect(bench, "fast.csv", {"--json"}) == 0);
    CHECK(bench.text("err").find("the rows, 1 s apart, are averaged to the unit's sample_time of "
                                 "10 s") != std::string::npos);
    return nlohmann::json::parse(bench.text("out"))["channels"][0]["verdict"].get<std::string>();
  };
  CHECK(verdict("15", "2") == "match");
  CHECK(verdict("45", "2") == "mismatch");
  CHECK(verdict("15", "3") == "mismatch");
}

/// Every index of one signal series, as its definition says it and in no other way.
double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}
double rms_of(std::vector<double> values) {
  for (double& value : values) value *= value;
  return std::sqrt(mean_of(values));
}

// The series are made here, and every number is computed from them once more, in two passes over
// whole vectors.
TEST_CASE("mpm detect says how well a unit is controlled") {
  Bench bench;
  write_file(bench.folder.file("small.yaml"),
             "unit: small\nsample_time: 1\nsignals: {mv: {tag: u, low: -1, high: 1.5, unit: t/h}, "
             "cv: [{tag: y, prediction: yhat, setpoint: sp, high: 0.5}, z]}\n"
             "model: {channels: [{cv: y, mv: u, gain: 2, time_constants: [10]}, {cv: z, mv: u, "
             "gain: 1, time_constants: [2]}]}\n");
  constexpr int kCount = 400;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> u, error, measured, residual;
  std::string text = "time,u,y,yhat,sp,z\n";
  double drift = 0.0;
  int standing = 0, run = 0;
  for (int k = 0; k < kCount; ++k) {
    const double setpoint = k < 200 ? 0.0 : 0.25;
    drift = 0.98 * drift + 0.1 * normal(random);
    const double prediction = 0.3 * std::sin(0.1 * k);
    const double y = prediction + drift;
    // Rests for 100 samples, and is clamped at either end now and then.
    u.push_back(k >= 250 && k < 350 ? 0.5 : std::clamp(normal(random), -1.0, 1.5));
    run = k > 0 && u[u.size() - 1] == u[u.size() - 2] ? run + 1 : 0;
    standing += run >= 60 ? 1 : 0;  // calibration::input_motion::kStillSamples
    measured.push_back(y);
    residual.push_back(y - prediction);
    error.push_back(y - setpoint);
    const auto number = [](double value) {
      std::ostringstream out;
      out.precision(17);
      out << value;
      return out.str();
    };
    text += std::to_string(k) + ',' + number(u.back()) + ',' + number(y) + ',' +
            number(prediction) + ',' + number(setpoint) + ",1\n";
  }
  write_file(bench.folder.file("a.csv"), text);
  REQUIRE(detect(bench, "a.csv", {"--json"}) == 0);
  const auto json = nlohmann::json::parse(bench.text("out"))["performance"];
  CHECK(json["samples"] == kCount);
  CHECK(json["service_factor"].get<double>() == Approx(1.0 - standing / double{kCount}));
  REQUIRE(json["cvs"].size() == 2);
  const auto& y = json["cvs"][0];
  CHECK(y["cv"] == "y");
  CHECK(y["setpoint"] == "sp");
  CHECK(y["samples"] == kCount);
  const double mean = mean_of(error);
  CHECK(y["control_error"]["mean"].get<double>() == Approx(mean));
  CHECK(y["control_error"]["rms"].get<double>() == Approx(rms_of(error)));
  for (double& value : error) value -= mean;
  CHECK(y["control_error"]["variance"].get<double>() ==
        Approx(std::pow(rms_of(error), 2) * kCount / (kCount - 1.0)));
  const auto outside =
      std::count_if(measured.begin(), measured.end(), [](double value) { return value > 0.5; });
  CHECK(outside > 0);
  CHECK(y["outside_limits"].get<double>() == Approx(static_cast<double>(outside) / kCount));
  // Three time constants settle: 30 samples. The last three wait in the screen.
  REQUIRE(y["prediction"].size() == 4);
  for (const auto& [at, horizon] : {std::pair{0, 1}, {1, 15}, {2, 30}, {3, 60}}) {
    std::vector<double> errors, moves;
    for (int k = horizon; k < kCount - 3; ++k) {
      const auto now = static_cast<std::size_t>(k), before = static_cast<std::size_t>(k - horizon);
      errors.push_back(residual[now] - residual[before]);
      moves.push_back(measured[now] - measured[before]);
    }
    const auto& told = y["prediction"][static_cast<std::size_t>(at)];
    CHECK(told["samples"] == horizon);
    CHECK(told["rmse"].get<double>() == Approx(rms_of(errors)));
    CHECK(told["movement_rms"].get<double>() == Approx(rms_of(moves)));
  }
  const auto& z = json["cvs"][1];
  CHECK(z["setpoint"].is_null());
  CHECK(z["control_error"].is_null());
  CHECK(z["outside_limits"].is_null());
  const auto& mv = json["mvs"][0];
  const auto share = [&u](auto holds) {
    return static_cast<double>(std::count_if(u.begin(), u.end(), holds)) / kCount;
  };
  CHECK(mv["unit"] == "t/h");
  CHECK(mv["at_low"].get<double>() == Approx(share([](double x) { return x <= -0.9875; })));
  CHECK(mv["at_high"].get<double>() == Approx(share([](double x) { return x >= 1.4875; })));
  CHECK(mv["at_limits"].get<double>() ==
        Approx(mv["at_low"].get<double>() + mv["at_high"].get<double>()));
  CHECK(mv["standing"].get<double>() == Approx(standing / double{kCount}));
  double travel = 0.0;
  for (std::size_t k = 1; k < u.size(); ++k) travel += std::abs(u[k] - u[k - 1]);
  CHECK(mv["travel"].get<double>() == Approx(travel / (kCount - 1.0)));

  // For people only where they ask.
  REQUIRE(detect(bench, "a.csv") == 0);
  CHECK(bench.text("out").find("Control performance") == std::string::npos);
  REQUIRE(detect(bench, "a.csv", {"--performance"}) == 0);
  CHECK(bench.text("out").find("Control performance\n  400 samples; the controller acts in 90 % "
                               "of them") != std::string::npos);
  CHECK(bench.text("out").find("--") != std::string::npos);  // z has no set-point
}

TEST_CASE("of one row nothing is told of control that one row cannot tell") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), rows(1));
  REQUIRE(detect(bench, "a.csv", {"--json"}) == 0);
  const auto json = nlohmann::json::parse(bench.text("out"))["performance"];
  CHECK(json["samples"] == 1);
  CHECK(json["cvs"][0]["control_error"]["mean"] == -2.0);  // 0 - 2
  CHECK(json["cvs"][0]["control_error"]["variance"].is_null());
  for (const auto& horizon : json["cvs"][0]["prediction"]) {
    CHECK(horizon["rmse"].is_null());
    CHECK(horizon["movement_rms"].is_null());
  }
  CHECK(json["mvs"][0]["travel"].is_null());
  CHECK(json["mvs"][0]["at_limits"].is_null());
}

}  // namespace
}  // namespace mpm::test::detect_test
