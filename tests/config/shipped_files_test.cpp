#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "config/load_unit.hpp"
#include "config/scenario_config.hpp"

namespace shipped_files_test {

using namespace mpm;
using namespace mpm::config;

namespace {

const std::string kConfigFolder = std::string(MPM_SOURCE_DIR) + "/config/";

UnitConfig load_clean(const std::string& path) {
  const LoadResult result = load_unit(path);
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  return result.config;
}

std::string printed(const UnitConfig& config) {
  std::ostringstream out;
  print_unit(config, out);
  return out.str();
}

struct Fopdt {
  double gain, time_constant_s, dead_time_s;
};

void check_channel(const UnitConfig& config, int cv, int input, const Fopdt& expected) {
  int found = 0;
  for (const ChannelSpec& channel : config.model.channels) {
    if (channel.cv != cv || channel.input != input) continue;
    ++found;
    const auto& tf = std::get<TransferFunction>(channel.dynamics);
    CHECK(tf.gain == expected.gain);
    CHECK(tf.time_constants_s == std::vector<double>{expected.time_constant_s});
    CHECK(tf.dead_time_s == Approx(expected.dead_time_s));
    CHECK(tf.lead_s == 0.0);
    CHECK_FALSE(tf.integrating);
  }
  CHECK(found == 1);
}

}  // namespace

TEST_CASE("Shipped unit files load without a finding and survive printing") {
  int files = 0;
  for (const char* folder : {"plants", "units", "cases"}) {
    for (const std::string& path : unit_files(kConfigFolder + folder)) {
      CAPTURE(path);
      ++files;
      const std::string once = printed(load_clean(path));
      const LoadResult again = load_unit_text(once, path);
      CHECK(again.findings.empty());
      CHECK(printed(again.config) == once);
    }
  }
  CHECK(files >= 14);
}

TEST_CASE("The Shell plant is eq. 4.1 of Carlsson 2010") {
  const UnitConfig config = load_clean(kConfigFolder + "plants/shell3x3.yaml");
  const Fopdt expected[3][3] = {{{4.05, 50, 6}, {1.77, 60, 7}, {5.88, 50, 6}},
                                {{5.39, 50, 4}, {5.72, 60, 3}, {6.90, 40, 3}},
                                {{4.38, 33, 5}, {4.42, 44, 5}, {7.20, 19, 0}}};
  Eigen::Matrix3d gains;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      check_channel(config, j, i, expected[j][i]);
      gains(j, i) = expected[j][i].gain;
    }
  }
  CHECK(gains.determinant() == Approx(20.85).epsilon(1e-4));  // by Sarrus: 20.849856
  CHECK(config.unit == "shell");
  CHECK(config.sample_time_s == 1.0);
  CHECK(config.cv[1].prediction == "yhat2");
  CHECK(config.cv[2].setpoint == "sp3");
  CHECK(config.simulation.noise.at(1).sigma == 0.01);
  CHECK(config.simulation.setpoints.at(1).amplitude == 0.5);
}

TEST_CASE("The Wood-Berry plant is the published one, in seconds") {
  const UnitConfig config = load_clean(kConfigFolder + "plants/wood_berry.yaml");
  const Fopdt minutes[2][3] = {{{12.8, 16.7, 1}, {-18.9, 21.0, 3}, {3.8, 14.9, 8.1}},
                               {{6.6, 10.9, 7}, {-19.4, 14.4, 3}, {4.9, 13.2, 3.4}}};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 3; ++i)
      check_channel(config, j, i,
                    {minutes[j][i].gain, std::round(minutes[j][i].time_constant_s * 60),
                     minutes[j][i].dead_time_s * 60});
  CHECK(config.sample_time_s == 60.0);
  CHECK(config.input_tag(2) == "feed");
  // RGA of the two MVs: 1 / (1 - k12 k21 / (k11 k22)) = 2.01, as every text on this column has it.
  CHECK(1.0 / (1.0 - (-18.9 * 6.6) / (12.8 * -19.4)) == Approx(2.01).epsilon(0.002));
}

TEST_CASE("Shipped scenarios load for the Shell plant without a finding") {
  const std::string unit_file = kConfigFolder + "plants/shell3x3.yaml";
  const UnitConfig shell = load_clean(unit_file);
  const UnitConfig with_aux = load_clean(kConfigFolder + "plants/shell3x3_ambient.yaml");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfigFolder + "scenarios")) {
    const std::string name = entry.path().stem();
    CAPTURE(name);
    ++files;
    const std::string path = find_scenario(name, unit_file);
    CHECK(std::filesystem::equivalent(path, entry.path()));
    const UnitConfig& unit = name == "unmodelled_input" ? with_aux : shell;
    const ScenarioResult result = load_scenario(path, unit, 6000.0);
    for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
    CHECK(result.scenario.name == name);
    CHECK_FALSE(result.scenario.description.empty());
  }
  CHECK(files >= 40);
}

TEST_CASE("The sensitivity scenarios differ from theirs in g alone") {
  const std::string unit_file = kConfigFolder + "plants/shell3x3.yaml";
  const UnitConfig unit = load_clean(unit_file);
  const auto load = [&](const std::string& name) {
    return load_scenario(find_scenario(name, unit_file), unit).scenario;
  };
  for (const auto& [prefix, base] : {std::pair<std::string, std::string>{"s3_g", "s3_delay"},
                                     std::pair<std::string, std::string>{"s4_g", "s4_gain40"}}) {
    const std::vector<Change> expected = load(base).changes;
    for (const int g : {5, 10, 20, 40, 80}) {
      const ScenarioConfig scenario = load(prefix + std::to_string(g));
      CAPTURE(scenario.name);
      CHECK(scenario.monitor.controlling_lags == g);
      REQUIRE(scenario.changes.size() == expected.size());
      for (std::size_t c = 0; c < expected.size(); ++c) {
        CHECK(scenario.changes[c].cv == expected[c].cv);
        CHECK(scenario.changes[c].mv == expected[c].mv);
        CHECK(scenario.changes[c].gain_ratio == expected[c].gain_ratio);
        CHECK(scenario.changes[c].dead_time_error_s == expected[c].dead_time_error_s);
      }
    }
  }
}

TEST_CASE("The plant with the high model, 25 % lower, is eq. 4.1 again") {
  const UnitConfig shell = load_clean(kConfigFolder + "plants/shell3x3.yaml");
  const UnitConfig high = load_clean(kConfigFolder + "plants/shell3x3_high_model.yaml");
  REQUIRE(high.model.channels.size() == 9);
  for (std::size_t c = 0; c < 9; ++c) {
    const auto& expected = std::get<TransferFunction>(shell.model.channels[c].dynamics);
    const int cv = high.model.channels[c].cv, input = high.model.channels[c].input;
    const double ratio = input == 0 && cv < 2 ? 0.75 : 1.0;
    CHECK(std::get<TransferFunction>(high.model.channels[c].dynamics).gain * ratio ==
          Approx(expected.gain).epsilon(1e-14));
    check_channel(high, cv, input,
                  {std::get<TransferFunction>(high.model.channels[c].dynamics).gain,
                   expected.time_constants_s[0], expected.dead_time_s});
  }
}

TEST_CASE("Events without a mismatch are for any plant") {
  const UnitConfig unit = load_clean(kConfigFolder + "plants/wood_berry.yaml");
  for (const char* name :
       {"noise_x3", "sensor_noise", "periodic", "coupled_noise", "heavy_tails", "all_events",
        "step_small", "step_large", "lagged_step", "ramp", "drift", "equal_setpoints",
        "one_setpoint", "controller_off", "constrained", "change_delay"}) {
    CAPTURE(name);
    const ScenarioResult result =
        load_scenario(kConfigFolder + "scenarios/" + name + ".yaml", unit, 180000.0);
    for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  }
}

TEST_CASE("No shipped scenario turns the sign of the Shell gains") {
  const std::string unit_file = kConfigFolder + "plants/shell3x3.yaml";
  const UnitConfig unit = load_clean(unit_file);
  for (const char* name : {"none", "s2_gain15", "s3_delay", "s4_gain40"}) {
    CAPTURE(name);
    const ScenarioResult result = load_scenario(find_scenario(name, unit_file), unit);
    Eigen::Matrix3d gains;
    for (const ChannelSpec& channel : unit.model.channels) {
      double& gain = gains(channel.cv, channel.input);
      gain = std::get<TransferFunction>(channel.dynamics).gain;
      for (const Change& change : result.scenario.changes)
        if ((!change.cv || *change.cv == unit.cv[static_cast<std::size_t>(channel.cv)].tag) &&
            (!change.mv || *change.mv == unit.input_tag(channel.input)))
          gain *= change.gain_ratio;
    }
    CHECK(gains.determinant() > 3.0);  // 20.85 without a change
  }
}

}  // namespace shipped_files_test
