#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <exception>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "config/cli/color.hpp"
#include "config/cli/command_tree.hpp"
#include "config/cli/decimals.hpp"
#include "config/cli/help_format.hpp"
#include "config/cli/slips.hpp"
#include "config/load_unit.hpp"
#include "config/replacement_file.hpp"
#include "config/scenario_config.hpp"
#include "config/time_text.hpp"
#include "idl/version.hpp"
#include "sim/options.hpp"
#include "sim/output/bad_data.hpp"
#include "sim/output/csv_writer.hpp"
#include "sim/output/result_file.hpp"
#include "sim/output/truth.hpp"
#include "sim/publish.hpp"
#include "sim/scenario/materiality.hpp"
#include "sim/scenario/prepare.hpp"

namespace mpm::sim {
namespace {

constexpr std::int64_t kDefaultSamples = 3000;  // of a data file

/// Bad input that has been told already, or whose text is the whole message.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void report(const std::vector<config::Finding>& findings) {
  for (const config::Finding& finding : findings) std::cerr << config::format(finding) << '\n';
  if (config::has_errors(findings)) throw BadInput("");
}

config::UnitConfig load_unit(const std::string& file) {
  config::LoadResult loaded = config::load_unit(file);
  report(loaded.findings);
  if (!loaded.config.has_model()) throw BadInput(file + ": error: the unit has no model");
  if (!loaded.config.calc.empty())
    throw BadInput(file + ": error: '" + loaded.config.calc.front().tag +
                   "' is calculated from other tags, and a simulation has no values of those");
  return std::move(loaded.config);
}

/// Length of the run where it has an end.
std::optional<double> run_length_s(const Options& options, const config::UnitConfig& unit) {
  std::optional<std::int64_t> samples = options.samples;
  if (!samples && !options.csv.empty()) samples = kDefaultSamples;
  if (!samples) return std::nullopt;
  return static_cast<double>(*samples) * unit.sample_time_s;
}

config::ScenarioConfig load_scenario(const Options& options, const config::UnitConfig& unit) {
  if (options.scenario == "none") {
    config::ScenarioConfig nothing;
    nothing.name = "none";
    return nothing;
  }
  const std::string file = config::find_scenario(options.scenario, options.config);
  config::ScenarioResult loaded = config::load_scenario(file, unit, run_length_s(options, unit));
  report(loaded.findings);
  return std::move(loaded.scenario);
}

std::int64_t start_time_ns(const Options& options) {
  if (options.start_time.empty())
    return options.csv.empty() ? std::chrono::duration_cast<std::chrono::nanoseconds>(
                                     std::chrono::system_clock::now().time_since_epoch())
                                     .count()
                               : 0;
  const std::optional<std::int64_t> start = config::parse_time(options.start_time);
  if (!start)
    throw BadInput("--start-time: neither seconds nor ISO 8601 with a zone: " + options.start_time);
  return *start;
}

LoopSetup prepare(const Options& options) {
  LoopSetup setup;
  setup.unit = load_unit(options.config);
  setup.scenario = load_scenario(options, setup.unit);
  const std::optional<double> run_s = run_length_s(options, setup.unit);
  for (const std::string& entry : options.bad_data)
    report(config::add_bad_data(entry, setup.unit, run_s, setup.scenario));
  if (run_s) setup.samples = std::llround(*run_s / setup.unit.sample_time_s);
  setup.seed = options.seed;
  setup.start_time_ns = start_time_ns(options);
  setup.controller_model = setup.unit.model;
  try {
    if (!options.controller_model.empty())
      setup.controller_model = match_signals(load_unit(options.controller_model), setup.unit);
    hide_changes(setup);
  } catch (const RefusedScenario& error) {
    if (error.finding().line > 0) report({error.finding()});
    throw BadInput(options.config + ": " + config::format(error.finding()));
  } catch (const std::invalid_argument& error) {
    throw BadInput(options.config + ": error: scenario '" + setup.scenario.name +
                   "': " + error.what());
  }
  return setup;
}

void write_truth(const LoopSetup& setup, const Options& options, const BadDataFilter& filter) {
  if (options.truth.empty()) return;
  ResultFile out(options.truth);
  out.stream() << truth_json(setup, options.controller_model, &filter);
  out.commit();
}

int run_csv(const LoopSetup& setup, const Options& options, BadDataFilter& filter) {
  ResultFile out(options.csv);
  ClosedLoop loop(setup);
  CsvWriter csv(out.stream(), setup.unit, static_cast<double>(setup.start_time_ns) * 1e-9,
                uncertain_tags(setup.scenario));
  const std::int64_t samples = options.samples.value_or(kDefaultSamples);
  for (std::int64_t k = 0; k < samples; ++k) {
    const Frame& frame = loop.step();
    if (!loop.finite()) {
      spdlog::error("sample {}: the loop has diverged, values are no longer finite", k);
      return kFailed;
    }
    if (const Frame* reported = filter.apply(frame)) csv.write(*reported, filter.time_error_s());
  }
  out.commit();
  if (loop.controller().held_count() > 0)
    spdlog::warn("the controller found no solution in {} of {} intervals and held its moves",
                 loop.controller().held_count(), samples);
  return kDone;
}

int run_limits(const LoopSetup& setup, double percent) {
  if (!setup.changes.empty() || !setup.scenario.plant.empty())
    throw BadInput("--limits: the scenario '" + setup.scenario.name +
                   "' changes the plant; take one that does not");
  const double rise = percent / 100.0;
  LoopSetup on_model = setup;  // what is asked is which errors of the model would cost
  on_model.unit.simulation.process.clear();
  print_limits(std::cout, on_model, materiality_limits(on_model, rise), rise);
  std::cout.flush();
  if (!std::cout) throw std::runtime_error("cannot write the limits");
  return kDone;
}

int run(const Options& options) {
  for (const std::string& output : {options.csv, options.truth})
    config::refuse_to_replace({options.config, options.controller_model, options.scenario}, output);
  config::refuse_one_place(options.csv, options.truth);
  const LoopSetup setup = prepare(options);
  if (options.limits_percent) return run_limits(setup, *options.limits_percent);
  BadDataFilter filter(setup);
  write_truth(setup, options, filter);
  int status = kDone;
  if (!options.csv.empty()) {
    status = run_csv(setup, options, filter);
  } else {
    block_stop_signals();
    status = run_dds(setup, options, filter);
  }
  if (!setup.scenario.bad_data.empty()) write_truth(setup, options, filter);  // with its counts
  return status;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app("Simulates an MPC-controlled plant whose process may differ from the model.",
               "mpmsim");
  app.formatter(std::make_shared<cli::HelpFormat>());
  Options options;
  declare(app, options);
  app.set_version_flag("--version", idl::version_text("mpmsim"));
  cli::add_no_color(app);
  cli::add_self_description(app, idl::version_text("mpmsim"));
  cli::read_decimals(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string slips = error.get_exit_code() == 0 ? "" : cli::slips_text(app);
    if (slips.empty()) return app.exit(error) == 0 ? kDone : kBadInput;
    std::cerr << slips << "Run with --help for more information.\n";
    return kBadInput;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt(
      "mpmsim", cli::color_refused() ? spdlog::color_mode::never : spdlog::color_mode::automatic));
  spdlog::set_pattern("%n: %^%l%$: %v");
  return run(options);
}

}  // namespace
}  // namespace mpm::sim

int main(int argc, char** argv) {
  using namespace mpm::sim;
  try {
    const int exit_code = parse_and_run(argc, argv);
    std::cout.flush();
    if (!std::cout) throw std::runtime_error("standard output cannot be written to");
    return exit_code;
  } catch (const BadInput& error) {
    if (*error.what() != '\0') std::cerr << "mpmsim: " << error.what() << '\n';
    return kBadInput;
  } catch (const mpm::config::InputError& error) {
    std::cerr << (error.finding().file.empty() ? "mpmsim: " : "") << error.what() << '\n';
    return kBadInput;
  } catch (const std::invalid_argument& error) {
    std::cerr << "mpmsim: error: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::exception& error) {
    std::cerr << "mpmsim: error: " << error.what() << '\n';
    return kFailed;
  }
}
