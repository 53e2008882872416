#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "config/load_unit.hpp"

namespace load_unit_test {

using namespace mpm;
using namespace mpm::config;

namespace {

// Every form that the unit file has, with values that no default equals.
const std::string kFull = R"(
unit: "unit 7"
sample_time: 2.5
signals:
  mv:
    - {tag: FIC-101.SP, unit: "%", description: "top: draw", low: 0.5, high: 60.5}
    - u2
    - {tag: "3"}
  dv: [d1]
  cv:
    - {tag: y1, prediction: yhat1, setpoint: sp1, unit: degC, high: 101}
    - y2
    - y3
  aux: [{tag: t_amb, unit: degC}]
model:
  channels:
    - {cv: y1, mv: FIC-101.SP, gain: 4.05, time_constants: [50, 5], lead: 3, dead_time: 6.25}
    - {cv: y1, mv: u2, gain: -1e-3, integrating: true}
    - {cv: y2, mv: d1, step_response: [0, 0.1, 0.19]}
    - {cv: y2, dv: d1x, gain: 1}
    - {cv: y2, mv: "3", numerator: 0.1, denominator: [1, -0.9], delay_samples: 3}
    - {cv: y3, mv: u2, gain: 2, time_constants: 60}
  input:
    FIC-101.SP: {polynomial: [1, 0.5]}
    u2: {saturation: [-1, 2]}
    "3": {stiction: {band: 2, jump: 1}}
    d1: {deadband: 0.5}
  output:
    y1: {saturation: [0, 10]}
    y2: {offset: -3}
    y3: {scale: 1.25}
  operating_point: {u2: 40, d1: 5, y1: 98}
monitor:
  memory: 9000
  false_alarm_rate: 0.02
  gain_error_of_interest: 0.3
  correlation: conventional
  threshold: mean_line
  nonlinear: kernel
  controlling_lags: 30
  first_lag: -5
  last_lag: 15
alarms:
  {raise_p_value: 1e-7, clear_p_value: 1e-2, on_delay: 25, off_delay: 125, latching: false,
   max_shelve: 3600, controller: {class: alarm, priority: high, consequence: the column floods,
   action: shed u1, time_to_respond: 600}}
dds:
  domain: 7
  interface: eth0
  peers: [10.0.0.1, host.example]
  multicast: true
  partition: plant a
  max_participants: 30
simulation:
  prediction_horizon: 80
  move_blocks: [4, 4]
  cv_weights: {y2: 2}
  move_weights: 0.5
  soft_limit_weight: 50
  limits:
    u2: {low: -2, high: 3, max_move: 0.5}
    y1: {low: 90}
  noise: {y1: {sigma: 0.1, pole: 0.5}, y3: {sigma: 0.2}}
  dv_movement: {sigma: 0.3, pole: 0.9}
  setpoints: {amplitude: 2, hold: 40}
)";

std::string full_text() {
  std::string text = kFull;
  const std::string wrong_line = "    - {cv: y2, dv: d1x, gain: 1}\n";
  text.erase(text.find(wrong_line), wrong_line.size());
  return text;
}

std::string printed(const UnitConfig& config) {
  std::ostringstream out;
  print_unit(config, out);
  return out.str();
}

UnitConfig load_clean(const std::string& text) {
  const LoadResult result = load_unit_text(text, "u.yaml");
  for (const Finding& finding : result.findings) FAIL_CHECK(format(finding));
  return result.config;
}

/// Everything that printing could lose.
void check_full(const UnitConfig& config) {
  CHECK(config.unit == "unit 7");
  CHECK(config.sample_time_s == 2.5);
  REQUIRE(config.mv.size() == 3);
  CHECK(config.mv[0].tag == "FIC-101.SP");
  CHECK(config.mv[0].unit == "%");
  CHECK(config.mv[0].description == "top: draw");
  CHECK(config.mv[2].tag == "3");
  REQUIRE(config.cv.size() == 3);
  CHECK(config.cv[0].prediction == "yhat1");
  CHECK(config.cv[0].setpoint == "sp1");
  CHECK(config.cv[1].prediction.empty());
  CHECK(config.aux.at(0).tag == "t_amb");

  const ModelSpec& model = config.model;
  CHECK(model.sample_time_s == 2.5);
  CHECK(model.input_count == 4);
  CHECK(model.cv_count == 3);
  REQUIRE(model.channels.size() == 5);
  const auto& lagged = std::get<TransferFunction>(model.channels[0].dynamics);
  CHECK(lagged.gain == 4.05);
  CHECK(lagged.time_constants_s == std::vector<double>{50, 5});
  CHECK(lagged.lead_s == 3);
  CHECK(lagged.dead_time_s == 6.25);
  CHECK_FALSE(lagged.integrating);
  const auto& integrating = std::get<TransferFunction>(model.channels[1].dynamics);
  CHECK(integrating.integrating);
  CHECK(integrating.gain == -1e-3);
  CHECK(integrating.time_constants_s.empty());
  CHECK(model.channels[2].cv == 1);
  CHECK(model.channels[2].input == 3);  // d1 comes after the three MVs
  CHECK(std::get<StepResponse>(model.channels[2].dynamics).values ==
        std::vector<double>{0, 0.1, 0.19});
  const auto& filter = std::get<DiscreteFilter>(model.channels[3].dynamics);
  CHECK(model.channels[3].input == 2);
  CHECK(filter.numerator == std::vector<double>{0.1});
  CHECK(filter.denominator == std::vector<double>{1, -0.9});
  CHECK(filter.delay_samples == 3);
  CHECK(std::get<TransferFunction>(model.channels[4].dynamics).time_constants_s ==
        std::vector<double>{60});

  REQUIRE(model.input_blocks.size() == 4);
  CHECK(std::get<Polynomial>(*model.input_blocks[0]).coefficients == std::vector<double>{1, 0.5});
  CHECK(std::get<Saturation>(*model.input_blocks[1]).low == -1);
  CHECK(std::get<Saturation>(*model.input_blocks[1]).high == 2);
  CHECK(std::get<Stiction>(*model.input_blocks[2]).band == 2);
  CHECK(std::get<Stiction>(*model.input_blocks[2]).jump == 1);
  CHECK(std::get<Deadband>(*model.input_blocks[3]).width == 0.5);
  REQUIRE(model.output_blocks.size() == 3);
  CHECK(std::get<Saturation>(*model.output_blocks[0]).high == 10);
  CHECK(std::get<Offset>(*model.output_blocks[1]).bias == -3);
  CHECK(std::get<Scale>(*model.output_blocks[2]).factor == 1.25);
  CHECK(model.input_origin == Eigen::Vector4d(0, 40, 0, 5));
  CHECK(model.output_origin == Eigen::Vector3d(98, 0, 0));

  CHECK(config.monitor.memory_s == 9000);
  CHECK(config.monitor.false_alarm_rate == 0.02);
  CHECK(config.monitor.gain_error_of_interest == 0.3);
  CHECK(config.monitor.correlation == CorrelationKind::kConventional);
  CHECK(config.monitor.threshold == ThresholdKind::kMeanLine);
  CHECK(config.monitor.nonlinear == NonlinearTest::kKernel);
  CHECK(config.monitor.controlling_lags == 30);
  CHECK(config.monitor.first_lag == -5);
  CHECK(config.monitor.last_lag == 15);
  CHECK(config.alarms.raise_p_value == 1e-7);
  CHECK(config.alarms.clear_p_value == 1e-2);
  CHECK_FALSE(config.alarm_handling.managed.latching);
  CHECK(config.alarm_handling.managed.max_shelve_s == 3600.0);
  CHECK(config.alarm_handling.controller.notification_class == NotificationClass::kAlarm);
  CHECK(config.alarm_handling.controller.priority == AlarmPriority::kHigh);
  CHECK(config.alarm_handling.controller.action == "shed u1");
  CHECK(config.alarm_handling.controller.off_delay_s == 28800.0);
  CHECK(config.alarms.on_delay_s == 25);
  CHECK(config.alarms.off_delay_s == 125);
  CHECK(config.dds.domain == 7);
  CHECK(config.dds.interface == "eth0");
  CHECK(config.dds.peers == std::vector<std::string>{"10.0.0.1", "host.example"});
  CHECK(config.dds.multicast);
  CHECK(config.dds.partition == "plant a");
  CHECK(config.dds.max_participants == 30);

  const SimulationSettings& simulation = config.simulation;
  CHECK(simulation.prediction_horizon == 80);
  CHECK(simulation.move_blocks == std::vector<int>{4, 4});
  CHECK(simulation.cv_weights == std::vector<double>{1, 2, 1});
  CHECK(simulation.move_weights == std::vector<double>{0.5, 0.5, 0.5});
  CHECK(simulation.soft_limit_weight == 50);
  REQUIRE(simulation.mv_limits.size() == 3);
  CHECK_FALSE(simulation.mv_limits[0].low);
  CHECK(simulation.mv_limits[1].low == -2.0);
  CHECK(simulation.mv_limits[1].high == 3.0);
  CHECK(simulation.mv_limits[1].max_move == 0.5);
  CHECK(simulation.cv_limits.at(0).low == 90.0);
  CHECK_FALSE(simulation.cv_limits.at(0).high);
  // Beside a signal they count instead of the simulation's.
  CHECK(config.mv_limits(0).low == 0.5);
  CHECK(config.mv_limits(0).high == 60.5);
  CHECK(config.mv_limits(1).low == -2.0);
  CHECK(config.mv_limits(1).high == 3.0);
  CHECK_FALSE(config.mv_limits(2).known());
  CHECK_FALSE(config.cv_limits(0).low);
  CHECK(config.cv_limits(0).high == 101.0);
  CHECK_FALSE(config.cv_limits(1).known());
  REQUIRE(simulation.noise.size() == 3);
  CHECK(simulation.noise[0].sigma == 0.1);
  CHECK(simulation.noise[0].pole == 0.5);
  CHECK(simulation.noise[1].sigma == 0.0);
  CHECK(simulation.noise[2].sigma == 0.2);
  CHECK(simulation.noise[2].pole == 0.95);
  CHECK(simulation.dv_movement.at(0).sigma == 0.3);
  CHECK(simulation.setpoints.at(2).amplitude == 2);
  CHECK(simulation.setpoints.at(2).hold_samples == 40);
}

/// A folder that goes away with the test.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("mpm_config_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

const std::string kSmall =
    "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: y1}\n"
    "model: {channels: {cv: y1, mv: u1, gain: 1}}\n";

}  // namespace

TEST_CASE("Every key of a unit file arrives") { check_full(load_clean(full_text())); }

TEST_CASE("A printed unit loads back as the same unit") {
  const std::string once = printed(load_clean(full_text()));
  const UnitConfig again = load_clean(once);
  check_full(again);
  CHECK(printed(again) == once);
}

TEST_CASE("Printing keeps every bit of a number") {
  UnitConfig config = load_clean(kSmall);
  for (const double gain : {0.1 + 0.2, 1e22, -5e-324, 1e30, 123456789012345.0}) {
    std::get<TransferFunction>(config.model.channels[0].dynamics).gain = gain;
    const UnitConfig again = load_clean(printed(config));
    CHECK(std::get<TransferFunction>(again.model.channels[0].dynamics).gain == gain);
  }
}

TEST_CASE("Printing keeps texts that YAML would take for something else") {
  UnitConfig config = load_clean(kSmall);
  for (const char* tag : {"true", "1.5", "null", "~", "a: b", "#x", "it's", "a\"b", "\\", "- x",
                          "[a", "5:30", "0x10", "Ü%", "yes", "a,b}"}) {
    config.mv[0].tag = tag;
    config.mv[0].description = tag;
    const UnitConfig again = load_clean(printed(config));
    CHECK(again.mv[0].tag == tag);
    CHECK(again.mv[0].description == tag);
  }
}

TEST_CASE("A state space arrives and survives printing") {
  const std::string text =
      "unit: t\nsample_time: 1\nsignals: {mv: [u1, u2], cv: y1}\n"
      "model:\n"
      "  state_space:\n"
      "    A: [[0.9, 0.1], [0, 0.8]]\n"
      "    B: [[1, 2], [3, 4]]\n"
      "    C: [[5, 6]]\n"
      "    x0: [7, 8]\n";
  for (const UnitConfig& config : {load_clean(text), load_clean(printed(load_clean(text)))}) {
    REQUIRE(config.model.state_space);
    const StateSpaceSpec& system = *config.model.state_space;
    CHECK(system.a == (Eigen::Matrix2d() << 0.9, 0.1, 0, 0.8).finished());
    CHECK(system.b == (Eigen::Matrix2d() << 1, 2, 3, 4).finished());
    CHECK(system.c == Eigen::RowVector2d(5, 6));
    CHECK(system.d == Eigen::RowVector2d(0, 0));
    CHECK(system.x0 == Eigen::Vector2d(7, 8));
  }
}

TEST_CASE("The operating point may stand at the top level") {
  const UnitConfig config = load_clean(kSmall + "operating_point: {u1: 3, y1: 4}\n");
  CHECK(config.model.input_origin(0) == 3);
  CHECK(config.model.output_origin(0) == 4);
}

TEST_CASE("Sections may be empty or missing, and defaults have the right length") {
  const UnitConfig config = load_clean(kSmall + "monitor:\nalarms: {}\ndds:\nsimulation:\n");
  CHECK(config.simulation.noise.size() == 1);
  CHECK(config.simulation.setpoints.at(0).hold_samples == 50);
  CHECK(printed(config) == printed(load_clean(kSmall)));
}

TEST_CASE(
    "A unit on the highest domain that options take loads, and so does what is printed of it") {
  const UnitConfig config = load_clean(kSmall + "dds: {domain: 230}\n");
  CHECK(config.dds.domain == kHighestDomain);
  CHECK(load_clean(printed(config)).dds.domain == kHighestDomain);
}

TEST_CASE("Files that cannot be read are findings") {
  const TemporaryFolder folder;
  const LoadResult missing = load_unit(folder.path() + "/nope.yaml");
  REQUIRE(missing.findings.size() == 1);
  CHECK(format(missing.findings[0]) == folder.path() + "/nope.yaml: error: no such file");
  const LoadResult directory = load_unit(folder.path());
  REQUIRE(directory.findings.size() == 1);
  CHECK(format(directory.findings[0]) == folder.path() + ": error: is a folder, not a file");
  // A regular file whose first byte is no memory of this process.
  const LoadResult broken = load_unit("/proc/self/mem");
  REQUIRE(broken.findings.size() == 1);
  CHECK(format(broken.findings[0]) == "/proc/self/mem: error: cannot be read: Input/output error");
}

TEST_CASE("What may not be read is told with the reason and the user") {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.yaml", kSmall);
  REQUIRE(::chmod(file.c_str(), 0) == 0);
  // To root nothing is forbidden.
  const uid_t user = ::geteuid(), nobody = 65534;
  const bool root = user == 0;
  if (root) REQUIRE(::seteuid(nobody) == 0);
  const LoadResult one = load_unit(file);
  if (root) REQUIRE(::seteuid(user) == 0);
  REQUIRE(::chmod(folder.path().c_str(), 0) == 0);
  if (root) REQUIRE(::seteuid(nobody) == 0);
  const LoadResult hidden = load_unit(file);
  const LoadUnitsResult all = load_units({folder.path()});
  if (root) REQUIRE(::seteuid(user) == 0);
  REQUIRE(::chmod(folder.path().c_str(), 0700) == 0);
  for (const std::vector<Finding>& findings : {one.findings, hidden.findings, all.findings}) {
    REQUIRE(findings.size() == 1);
    CHECK(findings[0].message.rfind("cannot be read: Permission denied (for user ", 0) == 0);
  }
}

TEST_CASE("What is no file in a folder of unit files is refused, not waited for") {
  const TemporaryFolder folder;
  (void)folder.write("a.yaml", kSmall);
  const std::string pipe = folder.path() + "/b.yaml";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const LoadUnitsResult result = load_units({folder.path()});
  REQUIRE(result.findings.size() == 1);
  CHECK(format(result.findings[0]) == pipe + ": error: is no file");
}

TEST_CASE("A folder stands for its unit files, sorted") {
  const TemporaryFolder folder;
  const std::string b = folder.write("b.yaml", kSmall);
  const std::string a = folder.write("a.yml", "unit: other" + kSmall.substr(7));
  (void)folder.write("notes.txt", "");
  (void)folder.write(".hidden.yaml", "");
  CHECK(unit_files(folder.path()) == std::vector<std::string>{a, b});
  CHECK(unit_files(b) == std::vector<std::string>{b});

  const LoadUnitsResult both = load_units({folder.path()});
  CHECK(both.ok());
  REQUIRE(both.units.size() == 2);
  CHECK(both.units[0].unit == "other");
  CHECK(both.units[1].unit == "t");
}

TEST_CASE("Two files of the same unit and a folder without units are errors") {
  const TemporaryFolder folder;
  const LoadUnitsResult empty = load_units({folder.path()});
  REQUIRE(empty.findings.size() == 1);
  CHECK(format(empty.findings[0]) ==
        folder.path() + ": error: the folder holds no unit file (*.yaml, *.yml)");

  const std::string a = folder.write("a.yaml", kSmall);
  const std::string b = folder.write("b.yaml", kSmall);
  const LoadUnitsResult twice = load_units({a, b});
  REQUIRE(twice.findings.size() == 1);
  CHECK(format(twice.findings[0]) == b + ":1:1: error: unit: 't' is already the unit of " + a);
}

}  // namespace load_unit_test
