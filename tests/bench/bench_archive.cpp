// What it takes to put a monitor away and to make it anew, with default settings and full memories:
//   build/release/tests/bench/bench_archive     (cmake --preset release -DMPM_BENCH=ON)
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "config/load_unit.hpp"
#include "core/archive/archive.hpp"
#include "core/model/linear_model.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSamples = 6000;  // more than any memory of the two units holds
constexpr int kTimes = 11;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double median_of(const std::function<double()>& measured) {
  std::vector<double> each(kTimes);
  std::generate(each.begin(), each.end(), measured);
  std::nth_element(each.begin(), each.begin() + kTimes / 2, each.end());
  return each[kTimes / 2];
}

double median_ms(const std::function<void()>& step) {
  return median_of([&] {
    const Clock::time_point begin = Clock::now();
    step();
    return ms_since(begin);
  });
}

config::UnitConfig square_unit(int size) {
  std::string text = "unit: square\nsample_time: 1\nsignals: {mv: [";
  for (int i = 0; i < size; ++i) text += "u" + std::to_string(i) + ", ";
  text += "], cv: [";
  for (int j = 0; j < size; ++j)
    text += "{tag: y" + std::to_string(j) + ", prediction: p" + std::to_string(j) + "}, ";
  text += "]}\nmodel:\n  channels:\n";
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j)
      text += "    - {cv: y" + std::to_string(j) + ", mv: u" + std::to_string(i) +
              ", gain: " + std::to_string(1.0 + 0.1 * (i == j ? 20 : (3 * i + j) % 7)) +
              ", time_constants: [" + std::to_string(20 + (5 * i + 3 * j) % 30) +
              "], dead_time: " + std::to_string((i + j) % 6) + "}\n";
  return config::load_unit_text(text, "square.yaml").config;
}

void measure(const std::string& name, const config::UnitConfig& unit) {
  report::UnitMonitor monitor(unit);
  LinearModel plant(unit.model);
  Frame frame(unit.counts());
  for (SignalBlock& block : frame.blocks)
    std::fill(block.quality.begin(), block.quality.end(), Quality::kGood);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd u = unit.model.input_origin;
  for (int k = 0; k < kSamples; ++k) {
    for (double& each : u) each += 0.1 * (normal(random) - each);
    frame.interval = k;
    frame.source_time_ns = k * std::int64_t{1'000'000'000};
    frame[SignalKind::kMv].values = u;
    frame[SignalKind::kPrediction].values = plant.output();
    frame[SignalKind::kCv].values = plant.output();
    for (double& each : frame[SignalKind::kCv].values) each += 0.05 * normal(random);
    monitor.push(frame);
    plant.advance(u);
  }
  std::vector<std::byte> bytes;
  const double away = median_ms([&] {  // into the memory of the time before, as mpmd does
    bytes.clear();
    Archive archive(bytes);
    archive(monitor);
  });
  // What somebody who comes in the midst of it has to wait at most, as in Checkpoints::rest.
  const double waits = median_of([&] {
    bytes.clear();
    double longest_ms = 0.0;
    Clock::time_point begin = Clock::now();
    Archive archive(bytes, [&] {
      longest_ms = std::max(longest_ms, ms_since(begin));
      begin = Clock::now();
      return false;
    });
    archive(monitor);
    return longest_ms;
  });
  report::UnitMonitor anew(unit);
  const double back = median_ms([&] { take_back(bytes, anew); });
  const double made = median_ms([&] { report::UnitMonitor another(unit); });
  std::printf(
      "%-10s %6.2f MB, put away in %.2f ms, of which somebody waits %.2f ms at most; taken back in "
      "%.2f ms, constructed in %.2f ms\n",
      name.c_str(), static_cast<double>(bytes.size()) * 1e-6, away, waits, back, made);
}

}  // namespace
}  // namespace mpm

int main() {
  mpm::measure("shell 3x3",
               mpm::config::load_unit(MPM_SOURCE_DIR "/config/plants/shell3x3.yaml").config);
  mpm::measure("10x10", mpm::square_unit(10));
}
