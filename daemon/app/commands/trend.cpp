#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/cli/color.hpp"
#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/progress_bar.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/bag/open_recording.hpp"
#include "daemon/history/digest_maker.hpp"
#include "daemon/history/read_journal.hpp"
#include "daemon/history/trend/changes.hpp"
#include "daemon/history/trend/trend.hpp"
#include "daemon/history/trend/trend_csv.hpp"
#include "daemon/history/trend/trend_json.hpp"
#include "daemon/history/trend/trend_svg.hpp"
#include "daemon/history/trend/trend_text.hpp"
#include "daemon/host/terminal.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::app {
namespace {

constexpr std::chrono::seconds kPatience{1};  // before the progress is shown

struct TrendOptions {
  std::string config;
  std::vector<std::string> data;
  std::vector<std::string> journal;
  std::string unit;
  std::string by;
  files::TimeChoiceText time;
  TimesText times;
  bool json = false;
  bool fail_on_mismatch = false;
  std::string csv;
  std::string svg;
};

/// Everything through the monitor, as `mpmd` would have it.
void take_data(const TrendOptions& options, const config::UnitConfig& unit,
               const files::TimeStyle& times, const files::TimeChoice& choice,
               history::TrendMaker& trend) {
  const std::unique_ptr<files::FrameSource> frames = bag::open_recording(options.data, unit, times);
  report::UnitMonitor monitor(unit);
  history::DigestMaker digests(unit);
  trend.add(digests.head(0));
  Frame frame(unit.counts());
  ProgressBar bar("reading", false, kPatience);
  while (frames->next(frame)) {
    bar.show(frames->share_read());
    if (!choice.takes(frame.source_time_ns)) continue;
    monitor.push(frame);
    if (const auto digest = digests.push(monitor)) trend.add(*digest);
    for (const AlarmRecord& alarm : monitor.alarms())
      trend.add({alarm.mv, alarm.cv, alarm.to == AlarmChange::kActive, alarm.source_time_ns});
  }
  if (const auto digest = digests.finish()) trend.add(*digest);
  tell_notices(frames->notices(), options.data.size() == 1 ? options.data.front() : "");
}

void take_journal(const TrendOptions& options, const files::TimeChoice& choice,
                  history::TrendMaker& trend) {
  for (const std::string& file : history::journal_of(options.journal, options.unit))
    history::read_journal(file, {[&](history::UnitHead head) { trend.add(std::move(head)); },
                                 [&](const history::Digest& digest) {
                                   if (choice.takes(digest.from_ns)) trend.add(digest);
                                 },
                                 [&](history::AlarmChangeNote alarm) {
                                   if (choice.takes(alarm.time_ns)) trend.add(std::move(alarm));
                                 }});
}

void write_file(const std::string& path, const std::string& text) {
  if (path.empty()) return;
  config::ReplacementFile file(path);
  file.write(text);
  file.commit();
}

// 0, 1 if a mismatch or a change was found and that was to fail, 3 on bad input.
int trend(const TrendOptions& options) {
  try {
    std::vector<std::string> inputs = options.data;
    inputs.insert(inputs.end(), options.journal.begin(), options.journal.end());
    inputs.push_back(options.config);
    config::refuse_to_replace(inputs, options.csv);
    config::refuse_to_replace(inputs, options.svg);
    config::refuse_one_place(options.csv, options.svg);
    const files::TimeStyle times = times_of(options.times);
    const files::TimeChoice choice(options.time, times);
    history::TrendMaker maker(from_string<history::Step>(options.by), times.zone.get());
    if (options.journal.empty()) {
      const config::LoadResult loaded = config::load_unit(options.config);
      for (const config::Finding& finding : loaded.findings)
        std::cerr << config::format(finding) << '\n';
      if (!loaded.ok()) return 3;
      take_data(options, loaded.config, times, choice, maker);
    } else {
      take_journal(options, choice, maker);
    }
    const history::Trend trend = maker.finish();
    if (trend.periods.empty())
      throw config::InputError(
          {mcap::name_of(options.journal.empty() ? options.data : options.journal), 0, 0,
           config::Severity::kError, "",
           std::string("holds nothing of the unit") + (choice.all() ? "" : " in the time chosen")});
    const history::Findings findings = find_changes(trend);
    const bool table_to_output = options.csv == "-";
    if (!table_to_output) write_file(options.csv, to_csv(trend));
    write_file(options.svg, to_svg(trend, findings, times.zone.get()));
    const report::Layout layout{host::terminal_width(STDOUT_FILENO),
                                host::wants_color(STDOUT_FILENO)};
    std::cout << (table_to_output ? to_csv(trend)
                  : options.json  ? to_json(trend, findings, times.zone.get()).dump() + "\n"
                                  : to_text(trend, findings, layout, times.zone.get()))
              << std::flush;
    return options.fail_on_mismatch && (trend.mismatch() || !findings.changes.empty()) ? 1 : 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_trend(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TrendOptions>();
  CLI::App* command = app.add_subcommand(
      "trend", "How well the model has fitted, by hour, day or week, and since when it does not");
  command->add_option("-c,--config", options->config, "unit file, with --data");
  CLI::Option* data = command->add_option(
      "--data", options->data,
      "history: CSV files in any historian layout, or MCAP recordings; several are one");
  CLI::Option* journal = command->add_option(
      "--journal", options->journal,
      "in place of --config and --data: journal files of mpmd, or folders of them");
  journal->excludes(data);
  command->add_option("--unit", options->unit, "whose journal, where a folder has several");
  command->add_option("--by", options->by, "length of a period (default: by that of the history)")
      ->check(CLI::IsMember({"hour", "day", "week"}));
  add_time_choice(*command, options->time);
  add_times(*command, options->times);
  cli::add_no_color(*command);
  command->add_flag("--json", options->json, "print one JSON object");
  command->add_option("--csv", options->csv,
                      "write a row for each period and channel to this file (-: print that alone)");
  command->add_option("--svg", options->svg, "draw the trend into this file");
  command->add_flag("--fail-on-mismatch", options->fail_on_mismatch,
                    "exit with 1 if a channel mismatches at the end, or anything changed");
  command->footer(
      "Examples:\n"
      "  mpm trend --config unit.yaml --data january.csv february.csv march.csv --svg trend.svg\n"
      "  mpm trend --journal /var/lib/mpm/journal --unit shell --by week");
  command->callback([options, &exit_code] {
    if (options->journal.empty() && options->data.empty())
      throw CLI::RequiredError("--data or --journal");
    if (options->journal.empty() && options->config.empty()) throw CLI::RequiredError("--config");
    exit_code = trend(*options);
  });
}

}  // namespace mpm::app
