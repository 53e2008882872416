#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "config/import_state_space.hpp"
#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "core/model/calibration.hpp"
#include "core/model/reduce_step_response.hpp"
#include "core/text/number_text.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/files/csv/state_space_folder.hpp"
#include "daemon/files/csv/step_table.hpp"

namespace mpm::app {
namespace {

struct ImportOptions {
  std::string table;
  std::string config;
  std::string out;
};

/// What became of each channel, one line each.
using Story = std::vector<std::string>;

std::string name_of(const config::UnitConfig& unit, const ChannelSpec& channel) {
  return unit.input_tag(channel.input) + " -> " + unit.cv[static_cast<std::size_t>(channel.cv)].tag;
}

std::string text_of(const ReducedStepResponse& reduced) {
  const TransferFunction& dynamics = reduced.dynamics;
  std::string text = dynamics.integrating ? "integrator, gain " : "gain ";
  text += number_text(dynamics.gain) + (dynamics.integrating ? " per s" : "");
  for (const double time_s : dynamics.time_constants_s)
    text += ", time constant " + number_text(time_s) + " s";
  if (dynamics.lead_s != 0.0) text += ", lead " + number_text(dynamics.lead_s) + " s";
  return text + ", dead time " + number_text(dynamics.dead_time_s) + " s; off by at most " +
         number_text(100.0 * reduced.deviation, 2) + " % of the largest coefficient";
}

/// Takes the response into the model, in fewer numbers where they say the same.
void take(ChannelSpec channel, config::UnitConfig& unit, Story& story) {
  const auto& response = std::get<StepResponse>(channel.dynamics);
  const std::string name = name_of(unit, channel);
  if (std::all_of(response.values.begin(), response.values.end(),
                  [](double value) { return value == 0.0; })) {
    story.push_back(name + ": all 0, left out");
    return;
  }
  const auto reduced = reduce_step_response(response, unit.sample_time_s);
  story.push_back(name + ": " +
                  (reduced
                       ? text_of(*reduced)
                       : "kept as a step response of " + counted(response.values.size(), "value") +
                             "; no lag, lead or integrator of second order or less is within " +
                             number_text(100.0 * calibration::step_reduction::kTolerance) + " %"));
  if (reduced) channel.dynamics = reduced->dynamics;
  unit.model.channels.push_back(std::move(channel));
}

/// The old model goes, but for its operating point.
void clear_model(config::UnitConfig& unit) {
  ModelSpec& model = unit.model;
  model.channels.clear();
  model.state_space.reset();
  model.state_terms.clear();
  model.disturbances.clear();
  std::fill(model.input_blocks.begin(), model.input_blocks.end(), std::nullopt);
  std::fill(model.output_blocks.begin(), model.output_blocks.end(), std::nullopt);
}

/// Tells every finding; false if one is an error.
bool tell(const std::vector<config::Finding>& findings) {
  for (const config::Finding& finding : findings) std::cerr << config::format(finding) << '\n';
  return !config::has_errors(findings);
}

/// False where the file is no model, which has then been told.
bool read_model(const ImportOptions& options, config::UnitConfig& unit, Story& story) {
  const bool folder = std::filesystem::is_directory(options.table);
  if (folder) unit.model.state_space = files::read_state_space_folder(options.table, unit);
  if (folder || options.table.ends_with(".json")) {
    if (!folder && !tell(config::import_state_space(options.table, unit))) return false;
    story.push_back("a state space of " +
                    counted(static_cast<std::uint64_t>(unit.model.state_space->a.rows()), "state"));
    return true;
  }
  files::StepTable table = files::read_step_table(options.table, unit);
  tell_notices(table.notices, options.table);
  for (ChannelSpec& channel : table.channels) take(std::move(channel), unit, story);
  if (!unit.has_model())
    throw config::InputError(
        {options.table, 0, 0, config::Severity::kError, "", "all coefficients are 0"});
  return true;
}

/// The unit file, read back; what that warns of is told.
std::string unit_text(const ImportOptions& options, const config::UnitConfig& unit) {
  std::ostringstream out;
  config::print_unit(unit, out);
  const config::LoadResult back = config::load_unit_text(out.str(), options.out);
  if (!tell(back.findings)) throw std::logic_error("the imported model does not load back");
  return out.str();
}

// 0, or 3 on bad input.
int import_model(const ImportOptions& options) {
  try {
    config::refuse_to_replace({options.config, options.table}, options.out);
    config::LoadResult loaded = config::load_unit(options.config, config::ModelNeed::kMayBeMissing);
    if (!tell(loaded.findings)) return 3;
    clear_model(loaded.config);
    Story story;
    if (!read_model(options, loaded.config, story)) return 3;
    const std::string text = unit_text(options, loaded.config);
    config::ReplacementFile file(options.out);
    file.write(text);
    file.commit();
    for (const std::string& line : story) std::cout << line << '\n';
    std::cout << "written to " << options.out << '\n' << std::flush;
    return 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_import(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command =
      app.add_subcommand("import", "Take a controller's model from another tool into a unit file");
  command
      ->add_option("table", options->table,
                   "step responses as CSV, a row cv,mv,<coefficients per sample> for each channel; "
                   "or a discrete state space: .json, {\"A\", \"B\", \"C\", \"D\", \"x0\"}, or a "
                   "folder with "
                   "A.csv, B.csv, C.csv and perhaps D.csv and x0.csv")
      ->required();
  command->add_option("-c,--config", options->config, "unit file; needs no model")->required();
  command->add_option("--out", options->out, "unit file to write, with the model")->required();
  command->footer(
      "Examples:\n"
      "  mpm import dmc_model.csv --config unit.yaml --out imported.yaml\n"
      "  mpm import matrices/ --config unit.yaml --out imported.yaml");
  command->callback([options, &exit_code] { exit_code = import_model(*options); });
}

}  // namespace mpm::app
