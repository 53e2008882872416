#include "daemon/app/commands/commands.hpp"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/cli/color.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/bus/watch/viewer.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/standard_output.hpp"
#include "daemon/host/terminal.hpp"
#include "idl/discovery.hpp"
#include "idl/output_readers.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::milliseconds kFrameTime{100};
constexpr std::chrono::seconds kBeforeNote{3};  // a monitor speaks each second

struct WatchOptions {
  std::string unit;
  idl::DomainOptions domain;
  bool json = false;
  bool alarms_only = false;
  bool until_alarm = false;
  double for_s = 0.0;  // 0 = until interrupted
};

bus::ViewMode mode_of(const WatchOptions& options) {
  if (options.json) return bus::ViewMode::kJson;
  return host::is_terminal(STDOUT_FILENO) ? bus::ViewMode::kTable : bus::ViewMode::kLines;
}

bus::RenderOptions render_options(const WatchOptions& options) {
  return {{host::terminal_width(STDOUT_FILENO), host::wants_color(STDOUT_FILENO)},
          options.alarms_only};
}

/// The processes behind writers; asks who is there when one is not known yet.
class WriterNames {
 public:
  explicit WriterNames(const idl::Participant& participant) : discovery_(participant) {}

  /// Empty where it has left before it was asked for.
  [[nodiscard]] std::string of(std::uint64_t writer) {
    const auto known = names_.find(writer);
    if (known != names_.end()) return known->second;
    const bus::Surroundings around{"", "", discovery_.endpoints(), {}};
    if (bus::find_writer(around, writer) == nullptr) return "";
    if (names_.size() >= kMost) names_.clear();
    return names_[writer] = bus::writer_name(around, writer);
  }

 private:
  static constexpr std::size_t kMost = 10'000;  // processes come and go

  idl::Discovery discovery_;
  std::map<std::uint64_t, std::string> names_;
};

// 0, or 2 if the alarm that was waited for did not come.
int watch(const WatchOptions& options) {
  using Clock = std::chrono::steady_clock;
  std::signal(SIGPIPE, SIG_IGN);  // has_reader() notices
  host::StopSignal stop;
  host::set_up_logging("warning");
  const idl::Participant participant(options.domain);
  // The table also shows the health; lines and JSON of alarms need nothing but alarms.
  const bus::ViewMode mode = mode_of(options);
  idl::OutputReaders readers(participant, options.alarms_only && mode != bus::ViewMode::kTable
                                              ? idl::OutputReaders::Scope::kAlarms
                                              : idl::OutputReaders::Scope::kEverything);
  idl::WaitSet wait_set;
  readers.attach_to(wait_set);
  WriterNames names(participant);
  bus::Viewer viewer(mode, render_options(options), options.unit);

  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(options.for_s));
  // A table says itself that nobody is there; who reads lines or JSON sees nothing.
  const std::string place = bus::place_text(options.domain);
  const Clock::time_point note_at = Clock::now() + kBeforeNote;
  bool heard = mode == bus::ViewMode::kTable, noted = false;
  bool last_look = false;
  while (viewer.has_reader() && !host::reader_has_left() && !stop.received()) {
    const bool any = wait_set.wait(kFrameTime);
    const Clock::time_point now = Clock::now();
    if (any) {
      const std::vector<idl::Output>& outputs = readers.take();
      for (std::size_t i = 0; i < outputs.size(); ++i)
        viewer.show(outputs[i], names.of(readers.writers()[i]), now);
      heard = heard || !outputs.empty();
    }
    if (!heard && !noted && now >= note_at) {
      std::cerr << "mpm: waiting for a monitor on " << place << std::endl;
      noted = true;
    }
    last_look = options.for_s > 0.0 && now >= end;
    viewer.tick(now);
    if (options.until_alarm && viewer.any_alarm()) return 0;
    if (last_look) break;
  }
  if (!heard && last_look) std::cerr << "mpm: no monitor was on " << place << std::endl;
  return options.until_alarm ? 2 : 0;
}

}  // namespace

void add_watch(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("watch", "show what the monitors say, live");
  const auto options = std::make_shared<WatchOptions>();
  command->add_option("--unit", options->unit, "only this unit");
  add_domain_flags(*command, options->domain);
  command->add_flag("--json", options->json, "print each record as a JSON line");
  cli::add_no_color(*command);
  command->add_flag("--alarms-only", options->alarms_only, "leave out what is not an alarm");
  command->add_flag("--until-alarm", options->until_alarm,
                    "end when an alarm is active; exit code 2 if none came");
  command->add_option("--for", options->for_s, "end after this time, as 90 or 1.5h")
      ->transform(positive_time_value());
  command->footer(
      "Examples:\n"
      "  mpm watch --unit shell\n"
      "  mpm watch --json --alarms-only --for 60\n"
      "  mpm watch --until-alarm --for 3600 && mail -s 'model mismatch' apc@plant");
  command->callback([options, &exit_code] { exit_code = watch(*options); });
}

}  // namespace mpm::app
