#include "daemon/app/commands/commands.hpp"

#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/choice.hpp"
#include "config/cli/color.hpp"
#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "config/scenario_config.hpp"
#include "daemon/app/commands/find_other_row.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/progress_bar.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/bag/open_recording.hpp"
#include "daemon/files/folder_name.hpp"
#include "daemon/history/journal.hpp"
#include "daemon/host/terminal.hpp"
#include "daemon/live/sample_journal.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "daemon/report/detect_report.hpp"
#include "daemon/report/detect_text.hpp"
#include "daemon/report/performance_text.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "daemon/report/unit_performance.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::seconds kPatience{1};                // before the progress is shown
constexpr std::uint64_t kWholeJournal = 1'000'000'000'000;  // bytes: nothing of it goes

struct DetectOptions {
  std::string config;
  std::vector<std::string> data;
  files::TimeChoiceText time;
  std::string scenario;
  std::string nonlinear;       // a name of `config::choices`; empty: as the files say
  std::string journal;         // folder
  std::string sample_journal;  // file
  TimesText times;
  bool json = false;
  bool performance = false;
  bool fail_on_mismatch = false;
};

/// What is kept of a run besides its report.
struct Journals {
  std::optional<history::Journal> journal;
  std::optional<live::SampleJournal> samples;

  Journals(const DetectOptions& options, const config::UnitConfig& unit) {
    if (!options.journal.empty())
      journal.emplace(unit, history::JournalFiles(options.journal, files::folder_name(unit.unit),
                                                  kWholeJournal));
    if (!options.sample_journal.empty()) samples.emplace(options.sample_journal);
    check();
  }

  void push(report::UnitMonitor& monitor) {
    if (journal) journal->push(monitor);
    if (samples) static_cast<void>(samples->write(monitor.channels(), monitor.alarms()));
    check();
  }
  void finish() {
    if (journal) journal->finish();
    check();
  }

 private:
  void check() const {
    for (const std::string& problem :
         {journal ? journal->problem() : "", samples ? samples->problem() : ""})
      if (!problem.empty())
        throw std::runtime_error("the journal could not be written: " + problem);
  }
};

/// What is left out is a gap for the monitor.
report::DetectReport run(const config::UnitConfig& unit, files::FrameSource& source,
                         const files::TimeChoice& choice, Journals& journals) {
  report::UnitMonitor monitor(unit);
  report::PerformanceTally performance(unit);
  report::DetectReport report;
  report.unit = unit.unit;
  files::UsedStretches used;
  Frame frame(unit.counts());
  ProgressBar bar("reading", false, kPatience);
  while (source.next(frame)) {
    bar.show(source.share_read());
    const bool taken = choice.takes(frame.source_time_ns);
    used.note(frame.source_time_ns, taken);
    if (!taken) continue;
    if (monitor.counters().frames == 0) report.first_ns = frame.source_time_ns;
    report.last_ns = frame.source_time_ns;
    monitor.push(frame);
    performance.push(frame, monitor.monitor().judged());
    report.alarms.insert(report.alarms.end(), monitor.alarms().begin(), monitor.alarms().end());
    journals.push(monitor);
  }
  journals.finish();
  report.take_counters(monitor.monitor(), unit);
  report.channels = monitor.channels();
  report.performance = performance.record();
  if (!choice.all()) report.used = used.stretches();
  return report;
}

/// Tells every finding; false if one is an error.
bool report(const std::vector<config::Finding>& findings) {
  for (const config::Finding& finding : findings) std::cerr << config::format(finding) << '\n';
  return !config::has_errors(findings);
}

std::vector<std::string> nonlinear_names() {
  std::vector<std::string> names;
  for (const auto& choice : config::choices(NonlinearTest{})) names.emplace_back(choice.name);
  return names;
}

void choose_nonlinear(const std::string& name, MonitorSettings& settings) {
  for (const auto& choice : config::choices(NonlinearTest{}))
    if (name == choice.name) settings.nonlinear = choice.kind;
}

// 0, 1 if a mismatch was found and that was to fail, 3 on bad input.
int detect(const DetectOptions& options) {
  config::LoadResult loaded = config::load_unit(options.config);
  if (!report(loaded.findings)) return 3;
  try {
    std::vector<std::string> inputs = options.data;
    inputs.push_back(options.config);
    config::refuse_to_replace(inputs, options.sample_journal);
    if (!options.scenario.empty()) {
      const config::ScenarioResult scenario = config::load_scenario(
          config::find_scenario(options.scenario, options.config), loaded.config);
      if (!report(scenario.findings)) return 3;
      loaded.config.monitor = scenario.scenario.monitor;
    }
    choose_nonlinear(options.nonlinear, loaded.config.monitor);
    const files::TimeStyle times = times_of(options.times);
    const std::unique_ptr<files::FrameSource> frames =
        bag::open_recording(options.data, loaded.config, times);
    const files::TimeChoice choice(options.time, times);
    Journals journals(options, loaded.config);
    report::DetectReport report = run(loaded.config, *frames, choice, journals);
    if (report::mismatching_cvs(report.channels) > 1)
      report.other_row = find_other_row(loaded.config, options.data, times, choice);
    tell_notices(frames->notices(), options.data.size() == 1 ? options.data.front() : "");
    if (report.samples == 0)
      throw config::InputError({mcap::name_of(options.data), 0, 0, config::Severity::kError, "",
                                "holds no control interval of unit '" + loaded.config.unit + "'" +
                                    (choice.all() ? "" : " in the time chosen")});
    const report::Layout layout{host::terminal_width(STDOUT_FILENO),
                                host::wants_color(STDOUT_FILENO)};
    std::cout << (options.json ? to_json(report).dump() + "\n"
                               : to_text(report, loaded.config, layout, times.zone.get()));
    if (options.performance && !options.json)
      std::cout << '\n' << report::performance_text(report.performance, layout);
    std::cout << std::flush;
    return options.fail_on_mismatch && report.mismatch() ? 1 : 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_detect(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DetectOptions>();
  CLI::App* command = app.add_subcommand(
      "detect", "Judge every channel on recorded data, exactly as the daemon would");
  command->add_option("-c,--config", options->config, "unit file")->required();
  command
      ->add_option("--data", options->data,
                   "data file: CSV in any historian layout, or MCAP recording; several, or a "
                   "folder of recordings, are one")
      ->required();
  command->add_option("--scenario", options->scenario,
                      "scenario (name or file) whose `monitor` settings replace the unit file's");
  command
      ->add_option("--nonlinear", options->nonlinear,
                   "nonlinear test of this run, in place of the unit file's and the scenario's")
      ->check(CLI::IsMember(nonlinear_names()));
  add_time_choice(*command, options->time);
  add_times(*command, options->times);
  cli::add_no_color(*command);
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_flag("--performance", options->performance,
                    "tell how well the unit is controlled as well; --json always does");
  command->add_option("--journal", options->journal,
                      "keep what mpmd keeps in its journal, in this folder");
  command->add_option("--journal-every-sample", options->sample_journal,
                      "append every sample's verdicts and alarms to this file as JSON lines");
  command->add_flag("--fail-on-mismatch", options->fail_on_mismatch,
                    "exit with 1 if any channel mismatches");
  command->footer(
      "Example:\n  mpm detect --config config/plants/shell3x3.yaml --data last_week.csv --json");
  command->callback([options, &exit_code] { exit_code = detect(*options); });
}

}  // namespace mpm::app
