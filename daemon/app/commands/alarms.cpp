#include <unistd.h>

#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "config/cli/color.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/journal_place.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/alarms/alarm_list.hpp"
#include "daemon/bus/alarms/list_text.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/history/load_text.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/terminal.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kStanding = 1;

struct AlarmsOptions {
  idl::DomainOptions domain;
  std::string unit;
  bool all = false;
  bool json = false;
  double wait_s = 3.0;
};

bool calls(const ControlRoomView& view) {
  return view.alarm_state == AlarmWord::kUnacknowledged ||
         view.alarm_state == AlarmWord::kAcknowledged || view.alarm_state == AlarmWord::kReturned;
}

bool any_calls(const bus::AlarmList& list, const std::string& unit) {
  const auto wanted = [&unit](const std::string& name) { return unit.empty() || name == unit; };
  for (const auto& [name, controller] : list.controllers)
    if (wanted(name) && calls(controller.view)) return true;
  for (const auto& [key, alarm] : list.channels)
    if (wanted(alarm.unit) && calls(alarm.view)) return true;
  return false;
}

void print_json(const AlarmsOptions& options, const bus::AlarmList& list) {
  const auto wanted = [&options](const std::string& name) {
    return options.unit.empty() || name == options.unit;
  };
  for (const auto& [name, controller] : list.controllers)
    if (wanted(name)) std::cout << report::json_text(report::json_of(controller)) << '\n';
  for (const auto& [key, alarm] : list.channels)
    if (wanted(alarm.unit) && (options.all || alarm.view.retain))
      std::cout << report::json_text(report::json_of(alarm)) << '\n';
}

int alarms(const AlarmsOptions& options) {
  host::StopSignal stop;
  host::set_up_logging("off");
  try {
    const idl::Participant participant(options.domain);
    const bus::AlarmList list =
        bus::listen_to_alarms(participant,
                              Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                 std::chrono::duration<double>(options.wait_s)),
                              [&stop] { return stop.received(); });
    const bool there =
        options.unit.empty() ? !list.controllers.empty() : list.controllers.count(options.unit) > 0;
    if (!there) {
      std::cerr << "mpm: error: no monitor" << (options.unit.empty() ? "" : " of " + options.unit)
                << " is heard on " << bus::place_text(options.domain) << '\n';
      return kFailed;
    }
    if (options.json)
      print_json(options, list);
    else
      std::cout << bus::alarm_list_text(
          list, options.unit, options.all,
          {host::terminal_width(STDOUT_FILENO), host::wants_color(STDOUT_FILENO)});
    return any_calls(list, options.unit) ? kStanding : kDone;
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kFailed;
  }
}

struct StatsOptions {
  JournalPlace place;
  bool json = false;
};

int stats(const StatsOptions& options) {
  try {
    const history::AlarmStore store(options.place.file, history::AlarmStore::Access::kRead);
    const history::LoadReport report = history::load_report(store, query_of(options.place));
    if (options.json)
      std::cout << report::json_text(history::load_json(report)) << '\n';
    else
      std::cout << history::load_text(report);
    return kDone;
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kFailed;
  }
}

void add_stats(CLI::App& alarms, int& exit_code) {
  CLI::App* command = alarms.add_subcommand(
      "stats", "how much the alarms asked of people, by the measures of ISA-18.2");
  const auto options = std::make_shared<StatsOptions>();
  add_journal_place(*command, options->place);
  command->add_flag("--json", options->json, "one JSON object");
  command->footer(
      "Example:\n  mpm alarms stats --journal /var/lib/mpm/alarms.sqlite --since 7d\n"
      "Exit codes: 0 done, 2 failed, 3 bad usage");
  command->callback([options, &exit_code] { exit_code = stats(*options); });
}

}  // namespace

void add_alarms(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("alarms", "which alarms stand, and what was done to them");
  const auto options = std::make_shared<AlarmsOptions>();
  add_domain_flags(*command, options->domain,
                   [options](const config::UnitConfig& unit) { options->unit = unit.unit; });
  command->add_option("--unit", options->unit, "of this unit alone (default: that of --config)");
  command->add_flag("--all", options->all, "those that are normal, too");
  cli::add_no_color(*command);
  command->add_flag("--json", options->json, "one JSON object a line and alarm");
  command->add_option("--wait", options->wait_s, "how long to listen at most")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->footer(
      "The first line of a unit is its controller's alarm, for the operator; the others are "
      "alerts\n"
      "of its channels, for the engineer.\n"
      "Examples:\n  mpm alarms --config shell.yaml\n  mpm alarms stats --since 30d\n"
      "Exit codes: 0 none calls, 1 some do, 2 failed or no monitor, 3 bad usage");
  add_stats(*command, exit_code);
  command->callback([command, options, &exit_code] {
    if (command->get_subcommands().empty()) exit_code = alarms(*options);
  });
}

}  // namespace mpm::app
