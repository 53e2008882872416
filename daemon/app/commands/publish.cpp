#include "daemon/app/commands/commands.hpp"

#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "config/cli/number_value.hpp"
#include "config/load_unit.hpp"
#include "config/unit_layout.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/bus/domain_options.hpp"
#include "daemon/files/csv/line_frames.hpp"
#include "daemon/host/interruptible_input.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "idl/unit_publisher.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::milliseconds kLongestSleep{200};

struct PublishOptions {
  std::string config;
  std::string format = "auto";
  std::string on_error = "stop";
  TimesText times;
  std::optional<int> domain;
  std::optional<std::string> partition;
  std::optional<std::string> security;
  double wait_readers_s = 5.0;
  int readers = 1;
  bool real_time = false;
  bool use_environment = false;
};

/// A stream that owns its buffer.
class StandardInput : public std::istream {
 public:
  explicit StandardInput(host::StopSignal& stop)
      : std::istream(nullptr), buffer_(STDIN_FILENO, [&stop] { return stop.received(); }) {
    rdbuf(&buffer_);
  }

 private:
  host::InterruptibleInput buffer_;
};

files::LineFormat format_of(const std::string& name) {
  if (name == "json") return files::LineFormat::kJson;
  return name == "csv" ? files::LineFormat::kCsv : files::LineFormat::kAuto;
}

void wait_for_readers(const idl::UnitPublisher& publisher, const PublishOptions& options,
                      host::StopSignal& stop) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(options.wait_readers_s));
  while (Clock::now() < end && !stop.received())
    if (publisher.wait_for_readers(kLongestSleep, options.readers)) return;
  if (options.wait_readers_s > 0.0 && !stop.received())
    std::cerr << "mpm publish: not every topic has a reader after " << options.wait_readers_s
              << " s; publishing all the same\n";
}

int publish_lines(const PublishOptions& options, const config::UnitConfig& unit,
                  host::StopSignal& stop) {
  const files::TimeStyle times = times_of(options.times);  // before any thread
  std::optional<files::LineFrames> first;
  try {
    first.emplace(std::make_unique<StandardInput>(stop), "stdin", format_of(options.format), unit,
                  times);
  } catch (const config::InputError&) {
    if (!stop.received()) throw;
    std::cerr << "mpm publish: stopped before the first line\n";
    return 0;
  }
  files::LineFrames& lines = *first;
  idl::DomainOptions domain = bus::domain_options(unit.dds, "gateway");
  domain.domain = options.domain.value_or(domain.domain);
  domain.partition = options.partition.value_or(domain.partition);
  domain.security = options.security.value_or(domain.security);
  domain.use_environment = options.use_environment;
  warn_of_environment(domain);
  const idl::Participant participant(domain);
  UnitLayout layout = config::unit_layout(unit);
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    if (lines.absent()[kind]) layout.signals[kind] = {};
  const idl::UnitPublisher publisher(
      participant, layout,
      options.real_time ? idl::WriterPace::kRealTime : idl::WriterPace::kLossless);
  wait_for_readers(publisher, options, stop);

  std::uint64_t published = 0, skipped = 0;
  Frame frame;
  while (!stop.received()) {
    try {
      if (!lines.next(frame) || stop.received()) break;  // what a stop cuts off is no line
    } catch (const config::InputError& error) {
      if (stop.received()) break;
      if (options.on_error == "stop") throw;
      std::cerr << error.what() << '\n';
      ++skipped;
      continue;
    }
    tell_notices(lines.take_notices());
    if (!publisher.publish(frame) && !options.real_time)
      throw std::runtime_error("interval " + std::to_string(frame.interval) +
                               ": a reader does not take samples");
    ++published;
  }
  tell_notices(lines.take_notices());
  if (!publisher.flush(kFlushTime)) std::cerr << "some readers do not have all samples\n";
  std::cerr << "mpm publish: " << counted(published, "line") << " published";
  if (skipped > 0) std::cerr << ", " << skipped << " skipped";
  std::cerr << '\n';
  return 0;
}

int publish(const PublishOptions& options) {
  const config::LoadResult loaded = config::load_unit(options.config);
  for (const config::Finding& finding : loaded.findings) std::cerr << format(finding) << '\n';
  if (!loaded.ok()) return 3;
  host::StopSignal stop;  // before any thread
  host::set_up_logging("warning");
  try {
    return publish_lines(options, loaded.config, stop);
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_publish(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("publish", "publish lines from standard input as a unit's samples");
  const auto options = std::make_shared<PublishOptions>();
  command->add_option("-c,--config", options->config, "unit file")->required();
  command->add_option("--format", options->format, "of the lines; auto looks at the first one")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "json", "csv"}));
  command->add_option("--on-error", options->on_error, "what to do about a line that is wrong")
      ->capture_default_str()
      ->check(CLI::IsMember({"stop", "skip"}));
  add_times(*command, options->times);
  command
      ->add_option("--wait-readers", options->wait_readers_s,
                   "how long to wait for a reader of every topic before the first line")
      ->capture_default_str()
      ->transform(time_value());
  command->add_option("--readers", options->readers, "how many readers of every topic to wait for")
      ->capture_default_str()
      ->check(cli::number_value(1.0));
  command->add_flag("--real-time", options->real_time,
                    "never wait for a slow reader; it loses the oldest samples");
  command->add_option("--domain", options->domain, "DDS domain, instead of the unit file's")
      ->check(CLI::Range(0, config::kHighestDomain));
  command->add_option("--partition", options->partition,
                      "discovery tag, instead of the unit file's");
  command->add_option("--security", options->security,
                      "folder of keys, as `mpm keys` makes, instead of the unit file's; taken are "
                      "those of the gateway");
  command->add_flag("--dds-from-environment", options->use_environment,
                    "take the DDS settings from CYCLONEDDS_URI");
  command->footer(
      "Lines: CSV with a header time,<tag>,... or JSON objects such as\n"
      "  {\"time\": 12.0, \"u1\": 0.5, \"y1\": 1.25, \"y1.quality\": \"uncertain\"}\n"
      "Example:\n  my_gateway | mpm publish --config shell.yaml --on-error skip\n"
      "Exit codes: 0 done, 2 failed, 3 bad usage or a wrong line");
  command->callback([options, &exit_code] { exit_code = publish(*options); });
}

}  // namespace mpm::app
