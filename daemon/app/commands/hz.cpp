#include <array>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "config/cli/number_value.hpp"
#include "core/signal/saturated.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/bus/window_statistics.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/standard_output.hpp"
#include "idl/discovery.hpp"
#include "idl/raw_reader.hpp"
#include "idl/topic_catalog.hpp"
#include "idl/wait_set.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kReportPeriod{1};
constexpr std::chrono::seconds kFindTime{3};  // for a topic of a type that we do not know

enum class Measure { kInterval, kDelay };

struct HzOptions {
  std::string topic;
  std::string unit;
  idl::DomainOptions domain;
  std::size_t window = 10000;
  double duration_s = 0.0;  // 0 = until interrupted
  bool json = false;
};

/// A topic of ours, or one whose writer describes its type.
std::optional<idl::RawReader> open(const idl::Participant& participant, const std::string& name,
                                   host::StopSignal& stop) {
  if (const idl::KnownTopic* topic = idl::find_known_topic(name))
    return idl::RawReader(participant, *topic);
  const idl::Discovery discovery(participant);
  const Clock::time_point end = Clock::now() + kFindTime;
  const idl::WaitSet nothing;
  while (Clock::now() < end && !stop.received()) {
    if (const idl::DiscoveredType type = discovery.type_of(name))
      return idl::RawReader(participant, name, type);
    (void)nothing.wait(idl::kLongestWait);
  }
  return std::nullopt;
}

void print(const HzOptions& options, Measure measure, const bus::WindowStatistics& values) {
  const double rate = values.mean() > 0.0 ? 1.0 / values.mean() : 0.0;
  const char* format =
      options.json ? (measure == Measure::kInterval
                          ? R"({"rate":%.6g,"min":%.6g,"max":%.6g,"std_dev":%.6g,"window":%zu})"
                          : R"({"delay":%.6g,"min":%.6g,"max":%.6g,"std_dev":%.6g,"window":%zu})")
      : measure == Measure::kInterval
          ? "average rate: %.3f  min: %.6f s  max: %.6f s  std dev: %.6f s  window: %zu"
          : "average delay: %.6f s  min: %.6f s  max: %.6f s  std dev: %.6f s  window: %zu";
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), format,
                measure == Measure::kInterval ? rate : values.mean(), values.min(), values.max(),
                values.deviation(), values.count());
  std::cout << line.data() << std::endl;
}

// 0, or 2 if too little came to tell, 3 if there is no such topic.
int measure_topic(const HzOptions& options, Measure measure) {
  std::signal(SIGPIPE, SIG_IGN);  // the stream notices
  host::StopSignal stop;
  host::set_up_logging("warning");
  const idl::Participant participant(options.domain);
  std::optional<idl::RawReader> reader = open(participant, options.topic, stop);
  if (!reader) {
    std::cerr << "mpm: error: nobody writes '" << options.topic << "' on "
              << bus::place_text(options.domain)
              << ", or not with a type that can be asked for; try mpm topics\n";
    return 3;
  }
  const std::string place = bus::place_text(options.domain);
  idl::WaitSet wait_set;
  wait_set.attach(reader->readable());
  bus::WindowStatistics values(options.window);
  std::optional<Clock::time_point> last;
  bool fresh = false;
  const auto on_sample = [&](const idl::RawSample& sample) {
    if (!sample.valid || (!options.unit.empty() && idl::unit_of(sample.cdr) != options.unit))
      return;
    const Clock::time_point now = Clock::now();
    if (measure == Measure::kDelay) {
      const std::chrono::nanoseconds wall = std::chrono::system_clock::now().time_since_epoch();
      values.add(1e-9 *
                 static_cast<double>(saturated_difference(wall.count(), sample.source_time_ns)));
    } else if (last) {
      values.add(std::chrono::duration<double>(now - *last).count());
    }
    last = now;
    fresh = true;
  };
  const Clock::time_point start = Clock::now();
  const Clock::time_point end = start + std::chrono::duration_cast<Clock::duration>(
                                            std::chrono::duration<double>(options.duration_s));
  Clock::time_point next_report = start + kReportPeriod;
  while (std::cout.good() && !host::reader_has_left() && !stop.received()) {
    if (wait_set.wait(idl::kLongestWait)) reader->take(on_sample);
    const Clock::time_point now = Clock::now();
    if (options.duration_s > 0.0 && now >= end) break;
    if (now < next_report) continue;
    next_report += kReportPeriod;
    if (fresh && values.count() > 0) print(options, measure, values);
    if (!last) std::cerr << options.topic << ": nothing has come yet on " << place << '\n';
    fresh = false;
  }
  if (host::reader_has_left()) return 0;
  if (values.count() == 0) {
    std::cerr << "mpm: error: " << options.topic << ": too few samples came on " << place << '\n';
    return 2;
  }
  if (std::cout.good()) print(options, measure, values);
  return 0;
}

void add(CLI::App& app, const char* name, const char* description, Measure measure,
         int& exit_code) {
  CLI::App* command = app.add_subcommand(name, description);
  const auto options = std::make_shared<HzOptions>();
  command->add_option("topic", options->topic, "mpm/mv, mpm/alarm ... or anybody else's")
      ->required();
  command->add_option("--unit", options->unit, "only samples of this unit");
  command->add_option("--window", options->window, "how many of the last samples count")
      ->capture_default_str()
      ->check(cli::number_value(1.0));
  command->add_option("--duration", options->duration_s, "end after this time, as 90 or 1.5h")
      ->transform(positive_time_value());
  command->add_flag("--json", options->json, "print JSON lines");
  add_domain_flags(*command, options->domain);
  command->footer(std::string("Example:\n  mpm ") + name +
                  " mpm/cv --duration 60\n"
                  "Exit codes: 0 done, 2 too few samples came, 3 bad usage or no such topic");
  command->callback(
      [options, measure, &exit_code] { exit_code = measure_topic(*options, measure); });
}

}  // namespace

void add_hz(CLI::App& app, int& exit_code) {
  add(app, "hz", "how often the samples of a topic come", Measure::kInterval, exit_code);
}

void add_delay(CLI::App& app, int& exit_code) {
  add(app, "delay", "how old the samples of a topic are when they come, by their DDS time stamps",
      Measure::kDelay, exit_code);
}

}  // namespace mpm::app
