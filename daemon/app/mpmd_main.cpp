#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/cli/color.hpp"
#include "config/cli/command_tree.hpp"
#include "config/cli/decimals.hpp"
#include "config/cli/help_format.hpp"
#include "config/cli/slips.hpp"
#include "config/load_unit.hpp"
#include "core/monitor/cost.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/quantity.hpp"
#include "daemon/host/locked_places.hpp"
#include "daemon/host/logging.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/standard_output.hpp"
#include "daemon/http/server.hpp"
#include "daemon/http/stored_events.hpp"
#include "daemon/keys/check_keys.hpp"
#include "daemon/live/alarm_journal.hpp"
#include "daemon/live/command_queue.hpp"
#include "daemon/live/diagnosis_worker.hpp"
#include "daemon/live/make_diagnosis.hpp"
#include "daemon/live/monitor_service.hpp"
#include "daemon/live/report_store.hpp"
#include "daemon/live/role.hpp"
#include "idl/version.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::milliseconds kPatience{500};    // with a diagnosis that is to end
constexpr std::chrono::seconds kLookPeriod{1};         // whether places are still there
constexpr std::uint64_t kSmallestJournal = 1'000'000;  // bytes
// Exit codes of all programs of the project.
constexpr int kDone = 0, kFound = 1, kFailed = 2, kBadInput = 3;

/// The one that systemd made for the service; the first if there are several.
std::string default_state_folder() {
  const char* folders = std::getenv("STATE_DIRECTORY");
  const std::string text = folders == nullptr ? "" : folders;
  return text.substr(0, text.find(':'));
}

struct Options {
  std::vector<std::string> config;
  bool check = false;
  bool print_config = false;
  std::optional<int> domain;
  std::optional<std::string> partition;
  std::optional<std::string> security;
  live::ServiceOptions service;
  std::string state_folder = default_state_folder();
  std::string token_file;
  bool standby = false;
  int standby_rank = 0;
  std::string log_level = "info";
  std::string http;  // address; empty: no page
  std::vector<std::string> http_names;
};

std::string address_problem(const std::string& text) {
  return http::parse_address(text) ? ""
                                   : "expected [ADDRESS:]PORT, the address in numbers: " + text;
}

void declare(CLI::App& app, Options& options) {
  app.add_option("-c,--config", options.config, "unit file, or folder of unit files; repeatable")
      ->required();
  app.add_flag("--check", options.check, "check the unit files, print all findings and exit");
  app.add_flag("--print-config", options.print_config,
               "print the effective unit files, defaults included, and exit");
  app.add_option("--domain", options.domain, "DDS domain of all units, instead of the unit files'")
      ->check(CLI::Range(0, config::kHighestDomain));
  app.add_option("--partition", options.partition,
                 "discovery tag of all units, instead of the unit files'");
  app.add_option("--security", options.security,
                 "folder of keys, as `mpm keys` makes, of all units, instead of the unit files'; "
                 "taken are those of the monitor");
  app.add_option("--journal", options.service.journal,
                 "keep what is to be known later in this folder, as JSON lines that `mpm trend` "
                 "reads: changes at once, digests each minute");
  app.add_option("--journal-keep", options.service.journal_keep,
                 "of the journals of all units together, in bytes or as 500MB, 2GB; the oldest "
                 "goes first (default: 1GB)")
      ->transform(size_value(kSmallestJournal));
  app.add_option("--journal-every-sample", options.service.sample_journal,
                 "append every sample's records to this file as JSON lines; a gigabyte a day of "
                 "nine channels at 1 s");
  app.add_option("--state-dir", options.state_folder,
                 "keep in this folder what a restart must not lose (of each unit what its samples "
                 "have made, and the last of these), the reports of diagnosed alarms and the "
                 "journal of alarms (default: "
                 "$STATE_DIRECTORY)");
  app.add_option("--alarm-journal", options.service.alarm_journal,
                 "keep what happens to alarms in this SQLite file, and what people did about them "
                 "over a restart; `mpm journal` reads it (default: alarms.sqlite in the state "
                 "folder)");
  app.add_option("--token-file", options.token_file,
                 "take commands (mpm ack, shelve ..., and those of the operator page) from those "
                 "who know the first line of this file; without it nobody can give any");
  app.add_flag("--standby", options.standby,
               "share the units with other monitors that are started so: one of them speaks, and "
               "should it fall silent another one goes on within a fifth of a second");
  app.add_option("--standby-rank", options.standby_rank,
                 "of several that start together the one of the greatest rank speaks")
      ->capture_default_str()
      ->check(CLI::Range(0, live::Role::kGreatestRank))
      ->needs("--standby");
  app.add_flag("--dds-from-environment", options.service.use_environment,
               "take the DDS settings from CYCLONEDDS_URI instead of the unit files");
  app.add_option(
         "--http", options.http,
         "serve the operator page and the HTTP API at [ADDRESS:]PORT; without an address on "
         "127.0.0.1, port 0 is any that is free")
      ->check(address_problem);
  app.add_option("--http-name", options.http_names,
                 "another host name by which the page is reached, as behind a proxy; repeatable")
      ->needs("--http");
  app.add_option("--log-level", options.log_level,
                 "what to log, to standard error; a service's goes to the system's journal: "
                 "journalctl -u mpmd")
      ->capture_default_str()
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}));
  app.set_version_flag("--version", idl::version_text("mpmd"));
  cli::add_no_color(app);
  cli::add_self_description(app, idl::version_text("mpmd"));
  app.footer(
      "Examples:\n"
      "  mpmd --config /etc/mpm/shell.yaml\n"
      "  mpmd --config /etc/mpm/units --journal /var/lib/mpm/journal --journal-keep 2GB\n"
      "  mpmd --config /etc/mpm/units --http 8080 --token-file /etc/mpm/token\n"
      "  mpmd --config /etc/mpm/units --standby\n"
      "  mpmd --config /etc/mpm/units --check\n"
      "Exit codes: 0 done, 1 --check found errors, 2 failed (a port or a folder is\n"
      "taken ...), 3 bad usage, unit file, key or token");
}

std::string cost_text(const config::UnitConfig& unit) {
  const MonitorCost cost = monitor_cost(unit.model, unit.monitor);
  return unit.unit + ": about " + number_text(1e-6 * cost.bytes, 2) + " MB and " +
         number_text(1e6 * cost.seconds, 2) + " us a sample, up to " +
         number_text(1e6 * cost.seconds_alarmed, 2) + " us while a channel of each CV is wrong (" +
         number_text(cost.columns) + " regression columns per CV)";
}

/// The operator page and all that stands behind it.
class Page {
 public:
  Page(const Options& options, const std::vector<config::UnitConfig>& units)
      : board_(units, options.service.journal),
        server_(*http::parse_address(options.http), board_, parts(options)) {
    board_.start();
    server_.start();
    spdlog::info("operator page at {}", server_.address().url());
    if (!server_.address().is_local())
      spdlog::warn(
          "the operator page is open to the network and not encrypted: put a proxy with TLS "
          "before it");
  }

  void attach_to(live::ServiceOptions& service) {
    service.observer = [this](const config::UnitConfig& unit) { return board_.feed_of(unit.unit); };
    service.commands = &commands_;
  }

 private:
  http::Api::Parts parts(const Options& options) {
    if (!options.service.alarm_journal.empty()) stored_.emplace(options.service.alarm_journal);
    return {.board = &board_,
            .events = stored_ ? &*stored_ : nullptr,
            .guard = http::Guard(options.http_names, options.service.token),
            .reports = http::KeptReports(options.state_folder),
            .version = idl::version_text("mpmd"),
            .command = [this](const AlarmCommand& command) { return commands_.ask(command); },
            .refused = [this](const AlarmCommand& command,
                              const std::string& why) { commands_.tell_refused(command, why); },
            .server = {}};
  }

  std::optional<http::StoredEvents> stored_;
  live::CommandQueue commands_;
  http::Board board_;
  http::Server server_;
};

/// Adds what is wrong with the monitor's keys, once where all units have those of an option.
void check_keys(config::LoadUnitsResult& loaded) {
  std::set<std::string> told;
  for (const config::UnitConfig& unit : loaded.units)
    for (const config::Finding& finding :
         keys::check_keys(unit.dds, keys::Role::kMonitor, std::time(nullptr)))
      if (told.insert(config::format(finding)).second) loaded.findings.push_back(finding);
}

config::LoadUnitsResult load(const Options& options) {
  config::LoadUnitsResult loaded = config::load_units(options.config);
  for (config::UnitConfig& unit : loaded.units) {
    if (options.domain) unit.dds.domain = *options.domain;
    if (options.partition) unit.dds.partition = *options.partition;
    if (options.security) {
      // A unit file, as which an extended model is written, takes absolute ones only.
      unit.dds.security =
          options.security->empty()  // who is there, whatever the unit file says
              ? ""
              : std::filesystem::absolute(*options.security).lexically_normal().string();
      unit.dds.security_at = {"--security", 0, 0, ""};
    }
  }
  if (loaded.ok() && !options.print_config) check_keys(loaded);
  return loaded;
}

/// The units as their files say now; nothing, and the log says why, where they cannot be taken.
/// `problem` says it in one line.
std::optional<std::vector<config::UnitConfig>> load_anew(const Options& options,
                                                         std::string& problem) {
  if (options.service.samples.empty()) {
    spdlog::warn(
        "SIGHUP: the unit files are not read anew without --state-dir, for all statistics "
        "would begin anew; restart to have that");
    problem = "without --state-dir";
    return std::nullopt;
  }
  config::LoadUnitsResult loaded = load(options);
  for (const config::Finding& finding : loaded.findings)
    spdlog::warn("SIGHUP: {}", config::format(finding));
  if (!loaded.ok() || loaded.units.empty()) {
    spdlog::error("SIGHUP: the unit files are not taken: {}; the units go on as they were",
                  loaded.units.empty() && loaded.ok() ? "there are none" : "they have errors");
    problem = "there are no unit files";
    for (const config::Finding& finding : loaded.findings)
      if (finding.severity == config::Severity::kError) {
        problem = config::format(finding);
        break;
      }
    return std::nullopt;
  }
  spdlog::info("SIGHUP: the unit files were read anew");
  return std::move(loaded.units);
}

/// What two would spoil if both wrote to it: journals whose entries build upon one another, samples
/// and states. Throws where another mpmd does.
host::LockedPlaces lock_places(const Options& options) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // who writes there tells
  std::set<std::string> places;
  const auto add = [&places](const std::string& path, const std::string& ending) {
    std::error_code failure;
    const fs::path real = fs::weakly_canonical(path, failure);  // one folder is locked once
    places.insert((failure ? path : real.string()) + ending);
  };
  if (const std::string& folder = options.state_folder; !folder.empty()) {
    fs::create_directories(folder, ignored);
    add(folder, "/.lock");
  }
  if (const std::string& folder = options.service.journal; !folder.empty()) {
    fs::create_directory(folder, ignored);
    add(folder, "/.lock");
  }
  if (!options.service.alarm_journal.empty()) add(options.service.alarm_journal, ".lock");
  host::LockedPlaces locked(places);
  for (const std::string& problem : locked.problems())
    spdlog::warn("cannot be locked against another mpmd: {}", problem);
  return locked;
}

int serve(const Options& options, std::vector<config::UnitConfig> units, host::StopSignal& stop,
          host::AwaitedSignal& hang_up, host::LockedPlaces& places) {
  spdlog::info("{} starts", idl::version_text("mpmd"));
  const live::ReportStore store(options.state_folder);
  live::DiagnosisWorker worker(
      [&store](const live::DiagnosisJob& job, const live::DiagnosisWorker::GoOn& go_on) {
        return live::make_diagnosis(job, store, go_on);
      });
  // Read anew, all units begin anew, and take again what they took: one way for what has changed
  // and for what has not.
  int askers = 0;
  std::chrono::steady_clock::time_point next_look{};
  for (bool again = true; again;) {
    again = false;
    std::optional<Page> page;
    if (!options.http.empty()) page.emplace(options, units);
    live::ServiceOptions service_options = options.service;
    if (page) page->attach_to(service_options);
    service_options.report_problem = store.problem();
    service_options.first_asker = std::exchange(askers, askers + static_cast<int>(units.size()));
    service_options.stop = [&stop] { return stop.received(); };
    std::optional<live::MonitorService> made;
    try {
      made.emplace(units, service_options, worker);
    } catch (const live::RecallStopped&) {
      break;
    }
    live::MonitorService& service = *made;
    service.run([&] {
      if (const auto now = std::chrono::steady_clock::now(); now >= next_look) {
        next_look = now + kLookPeriod;
        for (const std::string& line : places.look()) spdlog::warn(line);
      }
      if (hang_up.take()) {
        host::Notifier& notifier = service.notifier();
        notifier.reloading();
        std::string problem;
        if (auto anew = load_anew(options, problem)) {
          units = std::move(*anew);
          again = true;  // the next service says when it is ready
        } else {
          notifier.remark("not reloaded: " + problem);
          notifier.ready();
        }
      }
      return again || stop.received();
    });
    if (!again) service.notifier().stopping();
  }
  const bool idle = worker.stop(kPatience);
  spdlog::info("stopped");
  if (!idle) {
    // On a busy machine a thread of low priority may take long to hear of it. Nothing that it does
    // matters any more, but what it uses must stay.
    spdlog::default_logger()->flush();
    std::_Exit(kDone);
  }
  return kDone;
}

int run(Options& options) {
  config::LoadUnitsResult loaded = load(options);
  if (!options.token_file.empty()) try {
      options.service.token = host::CommandToken::read(options.token_file);
    } catch (const std::exception& error) {
      loaded.findings.push_back({"--token-file", 0, 0, config::Severity::kError, "", error.what()});
    }
  // Its own, in the state folder, it puts aside; what somebody names may be named by mistake.
  if (const std::string& journal = options.service.alarm_journal;
      live::AlarmJournal::is_foreign(journal))
    loaded.findings.push_back({"--alarm-journal", 0, 0, config::Severity::kError, "",
                               journal + ": holds something else than a journal of alarms"});
  for (const config::Finding& finding : loaded.findings)
    (options.check ? std::cout : std::cerr) << config::format(finding) << '\n';
  if (!loaded.ok()) return options.check ? kFound : kBadInput;
  if (options.check) {
    for (const config::UnitConfig& unit : loaded.units) std::cout << cost_text(unit) << '\n';
    return kDone;
  }

  if (options.print_config) {
    for (std::size_t i = 0; i < loaded.units.size(); ++i) {
      if (i > 0) std::cout << "---\n";
      config::print_unit(loaded.units[i], std::cout);
    }
    return kDone;
  }
  if (loaded.units.empty()) {
    std::cerr << options.config.front() << ": error: no unit files\n";
    return kBadInput;
  }

  // Before any thread. A service is hung up by who wants it to read its files anew.
  host::StopSignal stop({SIGTERM, SIGINT});
  host::AwaitedSignal hang_up({SIGHUP});
  host::set_up_logging(options.log_level);
  // What it writes is its own and its group's, also where no service manager says so.
  ::umask(::umask(0) | S_IRWXO | S_IWGRP);
  try {
    if (options.service.alarm_journal.empty() && !options.state_folder.empty())
      options.service.alarm_journal = options.state_folder + "/alarms.sqlite";
    if (options.standby) options.service.standby_rank = options.standby_rank;
    if (!options.state_folder.empty()) options.service.samples = options.state_folder + "/samples";
    host::LockedPlaces places = lock_places(options);
    return serve(options, std::move(loaded.units), stop, hang_up, places);
  } catch (const std::exception& error) {
    if (!spdlog::should_log(spdlog::level::err)) throw;  // no log is silence
    spdlog::error("mpmd: error: {}", error.what());
    return kFailed;
  }
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Monitors MPC units for model-plant mismatch: DDS in, verdicts and alarms out.",
               "mpmd");
  app.formatter(std::make_shared<cli::HelpFormat>());
  Options options;
  declare(app, options);
  cli::read_decimals(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const std::string slips = cli::slips_text(app);
    if (slips.empty())
      app.exit(error);
    else
      std::cerr << slips << "Run with --help for more information.\n";
    return kBadInput;
  }
  return run(options);
}

}  // namespace
}  // namespace mpm::app

int main(int argc, char** argv) {
  using namespace mpm::app;
  int exit_code = kFailed;
  bool told = false;
  try {
    exit_code = parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "mpmd: error: " << error.what() << '\n';
    told = true;
  }
  if (mpm::host::finish_standard_output()) return exit_code;
  if (!told) std::cerr << "mpmd: error: standard output cannot be written to\n";
  return kFailed;
}
