#include "daemon/app/commands/commands.hpp"

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "config/cli/color.hpp"
#include "config/cli/number_value.hpp"
#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "core/identify/diagnosis/diagnosis.hpp"
#include "core/parallel/parallel.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/find_other_row.hpp"
#include "daemon/app/commands/given_data.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/progress_bar.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/files/output_folder.hpp"
#include "daemon/files/read_recording.hpp"
#include "daemon/host/signals.hpp"
#include "daemon/host/terminal.hpp"
#include "daemon/report/closed_loop/compare_loops.hpp"
#include "daemon/report/closed_loop/run_mpmsim.hpp"
#include "daemon/report/diagnosis/diagnosis_report.hpp"
#include "daemon/report/pulses_text.hpp"
#include "daemon/report/report_files.hpp"
#include "daemon/report/terminal/terminal_text.hpp"
#include "daemon/report/unit_performance.hpp"
#include "idl/version.hpp"

namespace mpm::app {
namespace {

struct DiagnoseOptions {
  std::string config;
  std::vector<std::string> data;
  std::vector<std::string> validate;
  files::TimeChoiceText time;
  std::string out;
  std::string scenario;
  TimesText times;
  double fit_share = DiagnosisSettings().fit_share;
  int max_findings = DiagnosisSettings().max_findings;
  std::uint64_t seed = DiagnosisSettings().seed;
  int threads = available_threads();
  bool seed_given = false;
  bool json = false;
  bool quiet = false;
  bool fail_on_mismatch = false;
  bool print_settings = false;
};

[[noreturn]] void refuse(const std::string& file, const std::string& message) {
  throw config::InputError({file, 0, 0, config::Severity::kError, "", message});
}

/// Nothing where the unit file is wrong, which has then been told.
std::optional<config::UnitConfig> load(const std::string& file) {
  const config::LoadResult loaded = config::load_unit(file);
  if (loaded.ok() && !loaded.config.has_model())
    refuse(file, "holds no model, so there is nothing to diagnose");
  for (const config::Finding& finding : loaded.findings)
    std::cerr << config::format(finding) << '\n';
  if (!loaded.ok()) return std::nullopt;
  return loaded.config;
}

/// All of what the files hold; refuses what no diagnosis can use.
Given read_all(const std::vector<std::string>& files, const config::UnitConfig& unit,
               const files::TimeStyle& times, const files::TimeChoice& choice,
               std::vector<std::string>& notices, report::PerformanceTally* performance = nullptr) {
  Given all = read_given(files, unit, times, choice, notices, performance);
  const std::string problem =
      files::recording_problem(all.recording, unit, needed_samples(unit.model));
  if (!problem.empty()) refuse(all.name, problem);
  return all;
}

report::DiagnosisRun prepare(const DiagnoseOptions& options, const config::UnitConfig& given) {
  report::DiagnosisRun run;
  run.unit = given;
  const files::TimeStyle times = times_of(options.times);
  const files::TimeChoice choice(options.time, times);
  run.time_chosen = !choice.all();
  report::PerformanceTally performance(run.unit);
  Given data = read_all(options.data, run.unit, times, choice, run.notices, &performance);
  run.performance = performance.record();
  const Eigen::Index every =
      rows_to_average(data.recording, run.unit.model, rows_to_diagnose(data.recording.samples()));
  run.condensing = condense(data, every, run.notices);
  run.unit.model.sample_time_s = data.recording.sample_time_s;
  run.recording = std::move(data.recording);
  run.run_files = std::move(data.files);
  run.data_file = std::move(data.name);
  if (!options.validate.empty()) {
    Given unseen = read_all(options.validate, given, times, {}, run.notices);
    condense(unseen, every, run.notices);
    run.validation = std::move(unseen.recording);
    run.validation_run_files = std::move(unseen.files);
    run.validation_file = std::move(unseen.name);
  }
  run.zone = times.zone;
  run.program = idl::version_text("mpm");
  run.command_line = command_line();
  run.config_file = options.config;
  run.fit_share = run.validation ? 1.0 : options.fit_share;
  run.seed = options.seed;
  return run;
}

/// False where the user stopped it.
bool diagnose_run(const DiagnoseOptions& options, host::StopSignal& stop,
                  report::DiagnosisRun& run) {
  ProgressBar bar("diagnosing", options.quiet);
  DiagnosisSettings settings;
  settings.mv_count = run.unit.counts().mv;
  settings.fit_share = options.fit_share;
  settings.max_findings = options.max_findings;
  settings.seed = options.seed;
  settings.threads = options.threads;
  bool stopped = false;
  settings.progress = [&](double share) {
    bar.show(share);
    stopped = stopped || stop.received();
    return !stopped;
  };
  run.diagnosis = diagnose(run.unit.model, run.recording,
                           run.validation ? &*run.validation : nullptr, settings);
  const auto tell = [&](const std::string& file, const Recording& recording,
                        const std::vector<Pulse>& pulses) {
    const std::string text = report::pulses_text(run.unit, recording, pulses, run.zone.get());
    if (text.empty()) return;
    run.notices.push_back(file + ": " + text);
    if (!options.quiet) tell_notices({run.notices.back()});
  };
  tell(run.data_file, run.recording, run.diagnosis.unanswered);
  if (run.validation)
    tell(run.validation_file, *run.validation, run.diagnosis.validation_unanswered);
  return !stopped;
}

/// Whether the CVs of every data file are a row off, where something is wrong.
void look_at_other_rows(const DiagnoseOptions& options, const config::UnitConfig& given,
                        report::DiagnosisRun& run) {
  if (run.diagnosis.verdict == DiagnosisVerdict::kMatch) return;
  const files::TimeStyle times = times_of(options.times);
  const files::TimeChoice choice(options.time, times);
  std::set<report::OtherRow> rows;
  for (const std::string& file : options.data)
    rows.insert(find_other_row_if_wrong(given, {file}, times, choice));
  if (rows.size() == 1) run.other_row = *rows.begin();
  if (run.other_row == report::OtherRow::kNone) return;
  run.notices.push_back(report::other_row_text(run.other_row));
  if (!options.quiet) tell_notices({run.notices.back()}, run.data_file);
}

/// Nothing where none is wanted; the flag says whether the scenario is fit to be run.
std::optional<report::LoopPlan> plan(const DiagnoseOptions& options, const config::UnitConfig& unit,
                                     bool& fit) {
  fit = true;
  if (options.scenario.empty()) return std::nullopt;
  std::vector<config::Finding> findings;
  std::optional<report::LoopPlan> result =
      report::plan_loops(unit, options.config, options.scenario,
                         options.seed_given ? std::optional(options.seed) : std::nullopt, findings);
  for (const config::Finding& finding : findings) std::cerr << config::format(finding) << '\n';
  fit = result.has_value();
  return result;
}

/// Empty, or why there is no comparison: a reason to fail, but not to lose the diagnosis.
std::string add_closed_loop(const report::LoopPlan& loops, const config::UnitConfig& unit,
                            host::StopSignal& stop, report::DiagnosisRun& run) {
  try {
    run.closed_loop =
        report::compare_loops(loops, unit, run.diagnosis, [&stop] { return stop.received(); });
    return {};
  } catch (const report::SimulatorError& error) {
    return error.what();
  } catch (const config::InputError& error) {
    return error.what();
  }
}

void print(const DiagnoseOptions& options, const report::DiagnosisRun& run,
           const std::string& json) {
  if (options.json) {
    std::cout << json << std::flush;
  } else if (!options.quiet) {
    const std::string text = to_text(run) + "\n  written to " + options.out +
                             ": report.html, report.json, extended.yaml\n";
    std::cout << (host::is_terminal(STDOUT_FILENO)
                      ? report::sentences_wrapped(text, host::terminal_width(STDOUT_FILENO))
                      : text)
              << std::flush;
  }
}

// 0, 1 if something was found and that was to fail, 2 if it was stopped or the simulator failed.
int diagnose_unit(const DiagnoseOptions& options, const config::UnitConfig& unit) {
  files::OutputFolder folder(options.out);
  bool fit = false;
  const std::optional<report::LoopPlan> loops = plan(options, unit, fit);
  if (!fit) return 3;
  report::DiagnosisRun run = prepare(options, unit);
  if (!options.quiet) tell_notices(run.notices);
  host::StopSignal stop;
  if (!diagnose_run(options, stop, run)) {
    std::cerr << "mpm: stopped; nothing was written\n";
    return 2;
  }
  look_at_other_rows(options, unit, run);
  const bool repaired = !run.diagnosis.findings.empty();
  const std::string failure =
      loops && repaired ? add_closed_loop(*loops, unit, stop, run) : std::string();
  const std::string json = report::write_reports(run, folder);
  folder.commit();
  print(options, run, json);
  if (!failure.empty()) {
    std::cerr << "mpm: error: written without the comparison in closed loop: " << failure << '\n';
    return 2;
  }
  return options.fail_on_mismatch && !run.diagnosis.findings.empty() ? 1 : 0;
}

/// What a user may set, as it would be used, in YAML.
int print_settings(const DiagnoseOptions& options) {
  std::cout << "fit_share: " << number_text(options.validate.empty() ? options.fit_share : 1.0, 6)
            << "  # first part of the data that is fitted, 0..1; all of it with --validate\n"
            << "max_findings: " << options.max_findings << "  # causes named at most\n"
            << "seed: " << options.seed << "  # of the resampling behind the intervals of gains\n";
  return 0;
}

void refuse_to_replace_inputs(const DiagnoseOptions& options) {
  std::vector<std::string> inputs = options.data;
  inputs.insert(inputs.end(), options.validate.begin(), options.validate.end());
  inputs.push_back(options.config);
  for (const char* name : report::kDiagnosisFiles)
    config::refuse_to_replace(inputs, std::filesystem::path(options.out) / name);
}

int diagnose_file(const DiagnoseOptions& options) {
  try {
    refuse_to_replace_inputs(options);
    std::optional<config::UnitConfig> unit = load(options.config);
    return unit ? diagnose_unit(options, *unit) : 3;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_diagnose(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DiagnoseOptions>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "Show what the simulation gets wrong, name the cause, extend the model, measure the gain");
  command->add_option("-c,--config", options->config, "unit file (required)");
  command->add_option("--data", options->data,
                      "data file (required): CSV in any historian layout, MCAP recording, or a "
                      "folder of one that was split; of several each is a run of its own, at its "
                      "own level and from its own first state");
  command->add_option("--validate", options->validate,
                      "measure the gain on this data file (or several) and fit on all of --data");
  command->add_option("--out", options->out,
                      "folder (required) for report.html, report.json and extended.yaml; made if "
                      "need be");
  command
      ->add_option("--fit-share", options->fit_share,
                   "first part of the data that is fitted (of what came after a change in it, "
                   "as much); the gain is measured on the rest")
      ->capture_default_str()
      ->check(cli::number_value(0.2, 0.9));
  command
      ->add_option("--max-findings", options->max_findings,
                   "causes looked for at most; jumps of one CV found together count as one")
      ->capture_default_str()
      ->check(CLI::Range(1, 20));
  CLI::Option* seed =
      command
          ->add_option("--seed", options->seed,
                       "of the resampling behind the intervals; with a --scenario that draws what "
                       "it hides, of the run that made the data")
          ->capture_default_str();
  command
      ->add_option("--threads", options->threads,
                   "that work at once; nothing in the report depends on how many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_option("--scenario", options->scenario,
                      "compare how well the simulator's controller does on this scenario with the "
                      "unit file's model and with the extended one");
  add_time_choice(*command, options->time);
  add_times(*command, options->times);
  command->add_flag("--json", options->json, "print report.json too");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  cli::add_no_color(*command);
  command->add_flag("--fail-on-mismatch", options->fail_on_mismatch,
                    "exit with 1 if anything was found");
  command->add_flag("--print-settings", options->print_settings,
                    "print what may be set, as it would be used, and do nothing");
  command->footer(
      "Example:\n  mpm diagnose --config config/plants/shell3x3.yaml --data last_week.csv --out "
      "report");
  command->callback([options, seed, &exit_code] {
    if (options->print_settings) {
      exit_code = print_settings(*options);
      return;
    }
    const auto required = [](const char* name, const auto& value) {
      if (value.empty()) throw CLI::RequiredError(name);
    };
    required("--config", options->config);
    required("--data", options->data);
    required("--out", options->out);
    options->seed_given = seed->count() > 0;
    exit_code = diagnose_file(*options);
  });
}

}  // namespace mpm::app
