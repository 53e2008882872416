#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "config/load_unit.hpp"
#include "core/monitor/cost.hpp"
#include "core/monitor/monitor.hpp"

namespace mpm::config::cost_test {
namespace {

std::string unit(int inputs, int cvs, const std::string& channel, const std::string& rest = "") {
  std::string text = "unit: u\nsample_time: 1\nsignals:\n  mv: [";
  for (int i = 0; i < inputs; ++i)
    text += (i > 0 ? ", " : "") + ("{tag: u" + std::to_string(i)) + "}";
  text += "]\n  cv: [";
  for (int j = 0; j < cvs; ++j) text += (j > 0 ? ", " : "") + ("{tag: y" + std::to_string(j)) + "}";
  return text + "]\nmodel:\n  channels:\n    - {cv: y0, mv: u0, gain: 1, " + channel + "}\n" + rest;
}

/// What is said of the cost: the rest are signals without channels.
std::vector<Finding> of_cost(const std::string& text) {
  std::vector<Finding> found;
  for (Finding& finding : load_unit_text(text, "unit.yaml").findings)
    if (finding.message.find("the monitor of this unit would") == 0)
      found.push_back(std::move(finding));
  return found;
}

// By hand: 1 + 200 * 8 + 200 * 21 columns at least, squared, of 8 bytes, for two memories of each
// of 200 CVs, is more than 100 GB.
TEST_CASE("a unit that no machine has room for is refused at its place") {
  const std::vector<Finding> large = of_cost(unit(200, 200, "time_constants: [10]"));
  REQUIRE(large.size() == 1);
  CHECK(large[0].severity == Severity::kError);
  CHECK(large[0].line == 7);
  CHECK_THAT(large[0].message, Catch::EndsWith("; split the unit"));
  const std::vector<Finding> endless =
      of_cost(unit(1, 1, "time_constants: [10]", "monitor: {memory: 1e9}\n"));
  REQUIRE(endless.size() == 1);
  CHECK(endless[0].line == 9);
  CHECK_THAT(endless[0].message, Catch::EndsWith("; shorten its memory"));
  CHECK(endless[0].severity == Severity::kError);
}

TEST_CASE("a unit that takes longer than its samples is told") {
  std::string busy = unit(40, 40, "time_constants: [10]");
  CHECK(of_cost(busy).empty());
  busy.replace(busy.find("sample_time: 1"), 14, "sample_time: 0.001");
  const std::vector<Finding> told = of_cost(busy);
  REQUIRE(told.size() == 1);
  CHECK(told[0].severity == Severity::kWarning);
}

// bench_methods counts 6.9 MB of heap for the monitor of three by three of Shell's channels, 8.7
// with the kernel; two fifths are what is kept of each moment that a change may have been at.
TEST_CASE("what the monitor takes is told with all that it keeps") {
  const LoadResult loaded = load_unit(MPM_SOURCE_DIR "/config/plants/shell3x3.yaml");
  MonitorSettings settings = loaded.config.monitor;
  settings.nonlinear = NonlinearTest::kOff;
  const double linear = monitor_cost(loaded.config.model, settings).bytes;
  CHECK(linear > 5e6);
  CHECK(linear < 10e6);
  settings.nonlinear = NonlinearTest::kKernel;
  const double kernel = monitor_cost(loaded.config.model, settings).bytes;
  CHECK(kernel - linear > 1.2e6);
  CHECK(kernel - linear < 2.7e6);
}

// Of the same number of samples' time constants, so that what a sample takes stays the same.
TEST_CASE("a unit for which the kernel is too slow is told what would keep up") {
  const auto text_of = [](double sample_time) {
    std::string text = unit(10, 20, "time_constants: [" + std::to_string(10.0 * sample_time) + "]",
                            "monitor: {nonlinear: kernel}\n");
    const std::string slow = "sample_time: 1";
    return text.replace(text.find(slow), slow.size(),
                        "sample_time: " + std::to_string(sample_time));
  };
  const LoadResult loaded = load_unit_text(text_of(1.0), "unit.yaml");
  MonitorSettings settings = loaded.config.monitor;
  REQUIRE(settings.nonlinear == NonlinearTest::kKernel);
  const double kernel = monitor_cost(loaded.config.model, settings).seconds;
  settings.nonlinear = NonlinearTest::kPolynomial;
  const double polynomial = monitor_cost(loaded.config.model, settings).seconds;
  REQUIRE(polynomial < 0.8 * kernel);
  CHECK(of_cost(text_of(1.1 * kernel)).empty());
  const std::vector<Finding> told = of_cost(text_of(0.9 * kernel));
  REQUIRE(told.size() == 1);
  CHECK(told[0].severity == Severity::kWarning);
  CHECK(told[0].message.find("; with `nonlinear: polynomial` about ") != std::string::npos);
  const std::vector<Finding> neither = of_cost(text_of(0.5 * polynomial));
  REQUIRE(neither.size() == 1);
  CHECK(neither[0].message.find("polynomial") == std::string::npos);
}

// Its pole rounds to 1. A run of mpm detect took 198 MB; estimates are good to a factor of two.
TEST_CASE("what a channel costs that takes for ever is a number") {
  LoadResult loaded = load_unit_text(unit(1, 1, "time_constants: [1e30]"), "slow.yaml");
  auto& dynamics = std::get<TransferFunction>(loaded.config.model.channels[0].dynamics);
  dynamics.time_constants_s = {1e300};  // as no file may have it
  const MonitorCost cost = monitor_cost(loaded.config.model, loaded.config.monitor);
  CHECK(cost.bytes > 99e6);
  CHECK(cost.bytes < 396e6);
}

// 13 ms a sample it took before errors of slow channels were sized more seldom.
TEST_CASE("a slow channel in alarm does not cost more than a fast unit") {
  for (const char* slow : {"1e3", "1e5", "1e9"}) {
    const LoadResult loaded =
        load_unit_text(unit(1, 1, "time_constants: [" + std::string(slow) + "]"), "slow.yaml");
    const MonitorCost cost = monitor_cost(loaded.config.model, loaded.config.monitor);
    CHECK(cost.seconds_alarmed > cost.seconds);
    CHECK(cost.seconds_alarmed < 3e-3);
  }
}

// 5 time constants of 1e9 samples are no int any more.
TEST_CASE("a channel however slow can be monitored") {
  for (const char* slow : {"1e5", "1e9", "1e15", "1e30"}) {
    CAPTURE(slow);
    const LoadResult loaded =
        load_unit_text(unit(1, 1, "time_constants: [" + std::string(slow) + "]"), "slow.yaml");
    REQUIRE(loaded.ok());
    Monitor monitor(loaded.config.model, loaded.config.counts(), {false}, {}, {});
    Frame frame(loaded.config.counts());
    for (int k = 0; k < 50; ++k) {
      frame.interval = k;
      for (const SignalKind kind : {SignalKind::kMv, SignalKind::kCv}) {
        frame[kind].values(0) = k % 7;
        frame[kind].quality.assign(1, Quality::kGood);
      }
      monitor.push(frame);
    }
    CHECK(monitor.channel(0, 0).verdict == Verdict::kUndetermined);
  }
}

}  // namespace
}  // namespace mpm::config::cost_test
