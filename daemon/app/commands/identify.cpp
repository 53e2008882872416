#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "config/whole_file.hpp"
#include "core/identification/identify_long.hpp"
#include "core/parallel/parallel.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/given_data.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/files/output_folder.hpp"
#include "daemon/report/condensing/condensing_report.hpp"
#include "daemon/report/identification/identification_report.hpp"
#include "daemon/report/identification/new_unit.hpp"
#include "daemon/report/identification/plan_report.hpp"
#include "daemon/report/pulses_text.hpp"
#include "daemon/report/record_json.hpp"
#include "daemon/report/report_files.hpp"
#include "idl/version.hpp"

namespace mpm::app {
namespace {

struct IdentifyOptions {
  std::string config;
  std::vector<std::string> data;
  files::TimeChoiceText time;
  TimesText times;
  std::string out;
  std::string report;
  int threads = available_threads();
  bool open_loop = false;
  bool plan = false;
  bool json = false;
  bool quiet = false;
};

/// Nothing where the unit file is wrong, which has then been told.
std::optional<config::UnitConfig> load(const std::string& file) {
  config::LoadResult loaded = config::load_unit(file, config::ModelNeed::kMayBeMissing);
  for (const config::Finding& finding : loaded.findings)
    std::cerr << config::format(finding) << '\n';
  if (!loaded.ok()) return std::nullopt;
  return std::move(loaded.config);
}

std::string text_of(const std::string& file) {
  std::string why;
  std::optional<std::string> text = config::read_whole_file(file, why);
  if (!text)
    throw config::InputError({file, 0, 0, config::Severity::kError, "", "cannot be read: " + why});
  return *std::move(text);
}

report::IdentificationRun prepare(const IdentifyOptions& options, config::UnitConfig unit) {
  report::IdentificationRun run;
  run.unit = std::move(unit);
  const files::TimeStyle times = times_of(options.times);
  // Recorded predictions are another model's: data without them will do.
  config::UnitConfig measured = run.unit;
  for (config::CvSignal& cv : measured.cv) cv.prediction.clear();
  Given data = read_given(options.data, measured, times, files::TimeChoice(options.time, times),
                          run.notices);
  run.recording = std::move(data.recording);
  run.data_file = std::move(data.name);
  run.zone = times.zone;
  run.program = idl::version_text("mpm");
  run.command_line = command_line();
  run.config_file = options.config;
  run.out_file = options.out;
  return run;
}

std::string outcome(const IdentifyOptions& options, bool found) {
  if (!found) return "\nnothing could be identified; no unit file was written\n";
  return options.out.empty() ? std::string() : "\nwritten to " + options.out + "\n";
}

// 0, or 1 where nothing could be identified.
int identify_unit(const IdentifyOptions& options, config::UnitConfig unit) {
  const std::string unit_file = options.out.empty() ? "" : text_of(options.config);
  std::optional<files::OutputFolder> folder;
  if (!options.report.empty()) folder.emplace(options.report);
  report::IdentificationRun run = prepare(options, std::move(unit));
  if (!options.quiet) tell_notices(run.notices);
  IdentificationSettings settings;
  settings.hints = run.unit.identify;
  settings.open_loop = options.open_loop;
  settings.threads = options.threads;
  LongIdentification answer = identify_long(run.recording, settings);
  run.recording = std::move(answer.data.recording);
  run.condensing = answer.data.how;
  run.identification = std::move(answer.identification);
  const auto tell = [&](const std::string& notice) {
    run.notices.push_back(run.data_file + ": " + notice);
    if (!options.quiet) tell_notices({run.notices.back()});
  };
  if (run.condensing.any()) tell(report::condensing_text(run.condensing, run.recording.samples()));
  if (const std::string text = report::pulses_text(run.unit, run.recording,
                                                   run.identification.unanswered, run.zone.get());
      !text.empty())
    tell(text);
  if (options.plan)
    run.plan = test_plan(run.identification, report::test_limits(run.unit), run.unit.counts().mv);
  const bool found = report::found_any(run);
  if (found && !options.out.empty()) {
    const std::string yaml = report::new_unit_yaml(run, unit_file);
    config::ReplacementFile out(options.out);
    out.write(yaml);
    out.commit();
  }
  if (folder) {
    report::write_reports(run, *folder);
    folder->commit();
  }
  if (options.json)
    std::cout << report::json_text(to_json(run), 2) << '\n' << std::flush;
  else if (!options.quiet)
    std::cout << to_text(run) << outcome(options, found) << std::flush;
  return found ? 0 : 1;
}

void refuse_to_replace_inputs(const IdentifyOptions& options) {
  std::vector<std::string> inputs = options.data;
  inputs.push_back(options.config);
  config::refuse_to_replace(inputs, options.out);
  if (options.report.empty()) return;
  for (const char* name : report::kIdentificationFiles)
    config::refuse_to_replace(inputs, std::filesystem::path(options.report) / name);
}

int identify_file(const IdentifyOptions& options) {
  try {
    refuse_to_replace_inputs(options);
    std::optional<config::UnitConfig> unit = load(options.config);
    return unit ? identify_unit(options, std::move(*unit)) : 3;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_identify(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<IdentifyOptions>();
  CLI::App* command = app.add_subcommand("identify",
                                         "A model of a unit from tags and history, with what it is "
                                         "sure of and what it left out");
  command->add_option("-c,--config", options->config, "unit file; needs no model")->required();
  command
      ->add_option(
          "--data", options->data,
          "data file: CSV in any historian layout, MCAP recording, or a folder of one that "
          "was split; of several each is a run of its own, at its own level and from its "
          "own first state")
      ->required();
  command->add_option("--out", options->out,
                      "the unit file with the identified model (required, but for --plan)");
  command->add_option("--report", options->report,
                      "folder for report.html, which shows the model, and model.json: all that is "
                      "printed, with step responses and their bands; made if need be");
  command
      ->add_option("--threads", options->threads,
                   "that work at once; nothing in the model depends on how many")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
  command->add_flag("--plan", options->plan,
                    "say which MVs have moved too little, and how to move them");
  command->add_flag("--open-loop", options->open_loop,
                    "no controller moved the inputs in these data, whatever it looks like: a CV "
                    "that answers within its own sample looks like a controller");
  add_time_choice(*command, options->time);
  add_times(*command, options->times);
  command->add_flag("--json", options->json, "print model.json instead of the table");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(
      "Exit codes: 0 a model was written, 1 nothing could be identified, 3 bad usage or input\n"
      "Example:\n  mpm identify --config unit.yaml --data monday.csv tuesday.csv --out new.yaml");
  command->callback([options, &exit_code] {
    if (options->out.empty() && !options->plan) throw CLI::RequiredError("--out");
    exit_code = identify_file(*options);
  });
}

}  // namespace mpm::app
