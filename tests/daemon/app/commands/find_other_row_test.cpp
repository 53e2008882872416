#include "daemon/app/commands/find_other_row.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/system/process.hpp"

namespace mpm::test::find_other_row_test {
namespace {

constexpr const char* kUnit =
    "unit: small\nsample_time: 1\nsignals: {mv: [u, v], cv: [y, z]}\nmodel: {channels: [{cv: y, "
    "mv: u, gain: 2, time_constants: [5], dead_time: 2}, {cv: z, mv: v, gain: 2, time_constants: "
    "[5], dead_time: 2}]}\n";

/// Two loops under PI control, y(k + 1) = a y(k) + (1 - a) 2 u(k - 2) and noise on top, a = exp(-1
/// / 5), the first with another gain perhaps. What is logged a row late comes before its own cause:
/// the controller has seen it already.
std::string rows(int rows_late, double gain) {
  constexpr int kRows = 4000;
  const double factor = std::exp(-1.0 / 5.0);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<std::array<double, 2>> inputs, outputs;
  std::array<double, 2> state{}, noise{}, setpoint{}, integral{};
  for (int k = 0; k < kRows; ++k) {
    std::array<double, 2> u{}, y{};
    for (std::size_t i = 0; i < 2; ++i) {
      if (random() % 40 == 0) setpoint[i] = normal(random);
      noise[i] = 0.9 * noise[i] + 0.1 * normal(random);
      y[i] = state[i] + noise[i];
      const double error = setpoint[i] - y[i];
      u[i] = 0.2 * error + 0.04 * (integral[i] += error);
      const double delayed = k < 2 ? 0.0 : inputs[inputs.size() - 2][i];
      state[i] = factor * state[i] + (1.0 - factor) * (i == 0 ? gain : 2.0) * delayed;
    }
    inputs.push_back(u);
    outputs.push_back(y);
  }
  std::string text = "time,u,v,y,z\n";
  for (int k = 1; k + 1 < kRows; ++k) {
    const auto& u = inputs[static_cast<std::size_t>(k)];
    const auto& y = outputs[static_cast<std::size_t>(k - rows_late)];
    text += std::to_string(k) + ',' + std::to_string(u[0]) + ',' + std::to_string(u[1]) + ',' +
            std::to_string(y[0]) + ',' + std::to_string(y[1]) + '\n';
  }
  return text;
}

struct Bench {
  TemporaryFolder folder;

  Bench() { write_file(folder.file("small.yaml"), kUnit); }
  /// What the JSON of a command says about the CVs' rows.
  std::string told(const std::string& command, int rows_late, double gain,
                   std::vector<std::string> options = {}) const {
    write_file(folder.file("data.csv"), rows(rows_late, gain));
    std::vector<std::string> arguments = {"mpm",
                                          command,
                                          "--json",
                                          "--config",
                                          folder.file("small.yaml"),
                                          "--data",
                                          folder.file("data.csv")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    REQUIRE(run(arguments, folder.file("out"), folder.file("err")) == 0);
    return nlohmann::json::parse(read_file(folder.file("out"))).value("matches_with_cvs", "");
  }
};

TEST_CASE("that the CVs are a row off is told, and a wrong gain is not") {
  const Bench bench;
  CHECK(bench.told("detect", 0, 2.0).empty());
  CHECK(bench.told("detect", 1, 2.0) == "a row earlier");
  CHECK(bench.told("detect", -1, 2.0) == "a row later");
  CHECK(bench.told("detect", 0, 3.0).empty());
  CHECK(bench.told("detect", 1, 3.0).empty());
}

TEST_CASE("a diagnosis of CVs that are a row off says so, and one of a wrong gain does not") {
  const Bench bench;
  const std::vector<std::string> out = {"--out", bench.folder.file("report")};
  const std::string sentence = "with the CVs a row earlier no channel mismatches";
  CHECK(bench.told("diagnose", 1, 2.0, out) == "a row earlier");
  CHECK(read_file(bench.folder.file("err")).find(sentence) != std::string::npos);
  CHECK(read_file(bench.folder.file("report/report.html")).find(sentence) != std::string::npos);
  CHECK(bench.told("diagnose", 0, 3.0, out).empty());
  CHECK(read_file(bench.folder.file("err")).find("Time stamps") == std::string::npos);
}

}  // namespace
}  // namespace mpm::test::find_other_row_test
