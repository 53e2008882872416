#include "daemon/app/commands/commands.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/bag/convert.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::app {
namespace {

struct Options {
  std::string input;
  std::string output;
  std::string config;
  std::string unit;
  std::string layout = "wide";
  std::string time_zone;
  std::string from_time_zone;
  std::string time_format;
  files::TimeChoiceText time;
};

void tell(const Options& options, const bag::ConvertReport& report) {
  std::ostream& out = options.output == files::kStandardOutput ? std::cerr : std::cout;
  out << options.output << ": " << counted(report.rows, "row") << " of "
      << counted(report.signals, "signal") << " from " << files::utc_text(report.first_ns) << " to "
      << files::utc_text(report.last_ns) << "\n  " << counted(report.values, "value") << " ("
      << report.uncertain << " uncertain, " << report.bad << " bad), " << report.missing
      << " missing; " << counted(report.bytes, "byte") << "\n"
      << std::flush;
  tell_notices(report.notices, options.input);
}

// 0, or 3 on bad input.
int convert(const Options& options) {
  bag::ConvertOptions wanted;
  if (!options.config.empty()) {
    config::LoadResult loaded = config::load_unit(options.config);
    for (const config::Finding& finding : loaded.findings)
      std::cerr << config::format(finding) << '\n';
    if (!loaded.ok()) return 3;
    wanted.unit = std::move(loaded.config);
  }
  try {
    config::refuse_to_replace({options.config}, options.output);
    wanted.unit_name = options.unit;
    wanted.layout = options.layout == "long" ? files::CsvLayout::kLong : files::CsvLayout::kWide;
    wanted.seconds = options.time_zone == "seconds";
    wanted.output_zone = zone_of(options.time_zone);
    wanted.input_times =
        times_of({options.from_time_zone.empty() ? options.time_zone : options.from_time_zone,
                  options.time_format});
    wanted.choice = files::TimeChoice(options.time, wanted.input_times);
    tell(options, bag::convert(options.input, options.output, wanted));
    return 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Turn a recording (MCAP) into CSV, or CSV into a recording; values keep their last bit");
  command
      ->add_option("input", options->input,
                   "MCAP recording, a folder of one that was split, or CSV in any historian layout")
      ->required();
  command
      ->add_option("output", options->output,
                   "what to write: MCAP if it ends in .mcap, else CSV; - is CSV on standard output")
      ->required();
  command->add_option("-c,--config", options->config,
                      "unit file: which signals, and for MCAP on which topic each goes");
  command->add_option("--unit", options->unit, "unit to take from an MCAP file that holds several");
  command->add_option("--layout", options->layout, "of a CSV output")
      ->check(CLI::IsMember({"wide", "long"}))
      ->capture_default_str();
  command->add_option(
      "--time-zone", options->time_zone,
      "utc, seconds, or a zone such as Europe/Berlin: how a CSV output writes times, "
      "and what local times of a CSV input mean (default: utc, and local times are "
      "refused)");
  command->add_option("--from-time-zone", options->from_time_zone,
                      "zone of local times in a CSV input, where it is not that of --time-zone");
  add_time_choice(*command, options->time);
  add_time_format(*command, options->time_format);
  command->footer(
      "Examples:\n"
      "  mpm convert night.mcap night.csv\n"
      "  mpm convert historian.csv history.mcap --config config/plants/shell3x3.yaml "
      "--time-zone Europe/Berlin");
  command->callback([options, &exit_code] { exit_code = convert(*options); });
}

}  // namespace mpm::app
