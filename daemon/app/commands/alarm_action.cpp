#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/alarm/alarm_command.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/domain_flags.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/bus/alarms/alarm_list.hpp"
#include "daemon/bus/alarms/command_client.hpp"
#include "daemon/bus/unit_inputs.hpp"
#include "daemon/host/command_token.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"

namespace mpm::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRefused = 1;
constexpr int kIdBytes = 16;
constexpr const char* kUsualToken = "/etc/mpm/token";

std::string this_user() {
  const passwd* entry = ::getpwuid(::geteuid());
  return entry == nullptr ? std::to_string(::geteuid()) : entry->pw_name;
}

std::string this_host() {
  std::string name(256, '\0');
  if (::gethostname(name.data(), name.size() - 1) != 0) return "";
  name.resize(std::strlen(name.c_str()));
  return name;
}

std::string usual_token_file() {
  const char* named = std::getenv("MPM_TOKEN_FILE");
  return named == nullptr ? kUsualToken : named;
}

struct ActionOptions {
  AlarmAction action{};
  idl::DomainOptions domain;
  std::string unit, mv, cv;
  bool all = false;
  double duration_s = 0.0;
  bool once = false;
  std::string user = this_user();
  std::string comment;
  std::string token_file = usual_token_file();
  double wait_s = 5.0;
};

CommandRecord command_of(const ActionOptions& options) {
  CommandRecord command;
  command.unit = options.unit;
  command.mv = options.mv;
  command.cv = options.cv;
  command.action = to_string(options.action);
  command.duration_s = static_cast<std::int32_t>(
      std::ceil(std::min(options.duration_s, double{std::numeric_limits<std::int32_t>::max()})));
  command.once = options.once;
  command.user = options.user;
  command.host = this_host();
  command.comment = options.comment;
  return command;
}

/// The controller's alarm and those of its channels that stand, silenced or not.
std::vector<CommandRecord> all_standing(const ActionOptions& options, const bus::AlarmList& list) {
  std::vector<CommandRecord> commands;
  const auto add = [&](const std::string& mv, const std::string& cv) {
    CommandRecord command = command_of(options);
    command.mv = mv;
    command.cv = cv;
    commands.push_back(std::move(command));
  };
  const auto controller = list.controllers.find(options.unit);
  if (controller != list.controllers.end() && controller->second.view.retain) add("", "");
  for (const AlarmStateRecord* alarm : list.standing(options.unit)) add(alarm->mv, alarm->cv);
  return commands;
}

std::string name_of(const CommandRecord& command) {
  return command.unit + (command.cv.empty() ? "" : ": " + command.mv + " -> " + command.cv);
}

int act(const ActionOptions& options) {
  host::StopSignal stop;
  host::set_up_logging("off");  // what is to be said goes to standard error
  const auto stopped = [&stop] { return stop.received(); };
  try {
    const host::CommandToken token = host::CommandToken::read(options.token_file);
    const idl::Participant participant(options.domain);
    bus::CommandClient client(participant);
    const auto wait =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.wait_s));
    if (!client.wait_for_monitor(Clock::now() + wait, stopped)) {
      std::cerr << "mpm: error: nobody takes commands on " << bus::place_text(options.domain)
                << '\n';
      return kFailed;
    }
    std::vector<CommandRecord> commands = {command_of(options)};
    if (options.all)
      commands =
          all_standing(options, bus::listen_to_alarms(participant, Clock::now() + wait, stopped));
    if (commands.empty()) std::cout << options.unit << ": no alarm stands\n";
    int exit_code = kDone;
    for (CommandRecord& command : commands) {
      command.id = host::random_text(kIdBytes);
      command.time_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count();
      command.proof = token.proof(signed_text(command));
      const std::optional<CommandReplyRecord> reply =
          client.give(command, Clock::now() + wait, stopped);
      if (!reply) {
        std::cerr << "mpm: error: " << name_of(command) << ": no monitor of this unit answers\n";
        return kFailed;
      }
      std::cout << name_of(command) << ": " << (reply->accepted ? "" : "refused: ") << reply->text
                << '\n';
      if (!reply->accepted) exit_code = kRefused;
    }
    return exit_code;
  } catch (const std::exception& error) {
    std::cerr << "mpm: error: " << error.what() << '\n';
    return kFailed;
  }
}

CLI::App* add_action(CLI::App& app, int& exit_code, const char* name, AlarmAction action,
                     const char* description, const std::shared_ptr<ActionOptions>& options) {
  CLI::App* command = app.add_subcommand(name, description);
  options->action = action;
  options->domain.role = "operator";
  add_domain_flags(*command, options->domain,
                   [options](const config::UnitConfig& unit) { options->unit = unit.unit; });
  command->add_option("--unit", options->unit, "whose alarm (default: that of --config)");
  CLI::Option* mv = command->add_option(
      "--mv", options->mv, "of this channel, with --cv; without both: the controller's alarm");
  CLI::Option* cv = command->add_option("--cv", options->cv, "the same");
  mv->needs(cv);
  cv->needs(mv);
  command->add_flag("--all", options->all, "all alarms of the unit that are not normal")
      ->excludes(mv)
      ->excludes(cv);
  command->add_option("--comment", options->comment, "why; kept in the journal");
  command->add_option("--user", options->user, "who does it")->capture_default_str();
  command->add_option("--token-file", options->token_file,
                      "whose first line is the monitor's token too (default: $MPM_TOKEN_FILE, or "
                      "/etc/mpm/token)");
  command->add_option("--wait", options->wait_s, "for the monitor and for its answer, each")
      ->capture_default_str()
      ->transform(positive_time_value());
  command->callback([options, &exit_code] {
    if (options->unit.empty()) throw CLI::RequiredError("--config or --unit");
    exit_code = act(*options);
  });
  return command;
}

void add_plain(CLI::App& app, int& exit_code, const char* name, AlarmAction action,
               const char* description) {
  CLI::App* command =
      add_action(app, exit_code, name, action, description, std::make_shared<ActionOptions>());
  command->footer(std::string("Example:\n  mpm ") + name +
                  " --config shell.yaml --mv u1 --cv y1 --comment \"work order 4711\"\n"
                  "Exit codes: 0 done, 1 the monitor refused it, 2 failed, 3 bad usage");
}

}  // namespace

void add_alarm_actions(CLI::App& app, int& exit_code) {
  add_plain(app, exit_code, "ack", AlarmAction::kAcknowledge, "acknowledge an alarm");
  const auto options = std::make_shared<ActionOptions>();
  CLI::App* shelve = add_action(app, exit_code, "shelve", AlarmAction::kShelve,
                                "silence an alarm for a time", options);
  shelve->add_option("--for", options->duration_s, "how long, as 90min or 8h")
      ->transform(positive_time_value());
  shelve->add_flag("--once", options->once,
                   "until it clears, and no longer than --for (default: as the unit allows)");
  shelve->footer(
      "Examples:\n  mpm shelve --config shell.yaml --mv u1 --cv y1 --for 8h --comment \"known\"\n"
      "  mpm shelve --config shell.yaml --once\n"
      "Exit codes: 0 done, 1 the monitor refused it, 2 failed, 3 bad usage");
  add_plain(app, exit_code, "unshelve", AlarmAction::kUnshelve, "end the shelving of an alarm");
  add_plain(app, exit_code, "suppress", AlarmAction::kSuppress,
            "silence an alarm that means nothing in this state of the plant");
  add_plain(app, exit_code, "unsuppress", AlarmAction::kUnsuppress, "end that");
  add_plain(app, exit_code, "out-of-service", AlarmAction::kOutOfService,
            "silence an alarm while its controller or instrument is maintained");
  add_plain(app, exit_code, "in-service", AlarmAction::kInService, "end that");
}

}  // namespace mpm::app
