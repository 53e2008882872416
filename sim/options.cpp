#include "sim/options.hpp"

#include <CLI/CLI.hpp>

#include "config/cli/number_value.hpp"
#include "config/unit_config.hpp"

namespace mpm::sim {
namespace {

constexpr double kMostSamples = 9e15;  // numbers up to 2^53 are taken

}  // namespace

void declare(CLI::App& app, Options& options) {
  app.add_option("-c,--config", options.config, "unit file of the plant and its controller")
      ->required();
  app.add_option("-s,--scenario", options.scenario,
                 "what is hidden in the plant: a scenario's name or file")
      ->capture_default_str();
  app.add_option("--bad-data", options.bad_data,
                 "spoils what is reported, beside the scenario: KIND=SHARE of missing, uncertain, "
                 "gaps, frozen, spikes, clipping, time_jitter; clock_steps=SECONDS; more keys "
                 "behind a comma, as frozen=5%,run=60; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--controller-model", options.controller_model,
                 "unit file whose model the controller uses instead of the plant's own");
  app.add_option("-n,--samples", options.samples,
                 "control intervals to run (3000 with --csv, else until stopped)")
      ->check(cli::number_value(0.0, kMostSamples));
  app.add_option("--seed", options.seed, "of all random numbers; same seed, same numbers")
      ->capture_default_str();
  app.add_option("--csv", options.csv,
                 "write this data file when it is whole (- is stdout); no DDS");
  app.add_option("--truth", options.truth, "write what was hidden to this JSON file");
  app.add_option(
         "--limits", options.limits_percent,
         "print, for the unit file, which errors of each channel make the controller's cost "
         "rise by so many per cent; no run")
      ->check(cli::number_value(0.1, 1000.0));
  app.add_option("--start-time", options.start_time,
                 "of the first sample: ISO 8601 with zone, or seconds since 1970 "
                 "(0 with --csv, else now)");
  app.add_option("--speed", options.speed,
                 "samples times real time on DDS; 0 = as fast as readers keep up")
      ->capture_default_str()
      ->check(cli::number_value(0.0));
  app.add_option("--wait-readers", options.wait_readers_s,
                 "seconds to wait for readers of every topic before the first sample "
                 "(10 with --speed 0 or --readers, else none)")
      ->check(cli::number_value(0.0));
  app.add_option("--readers", options.readers, "how many readers of every topic to wait for")
      ->capture_default_str()
      ->check(cli::number_value(1.0));
  app.add_option("--domain", options.domain, "DDS domain, instead of the unit file's")
      ->check(CLI::Range(0, config::kHighestDomain));
  app.add_option("--partition", options.partition, "discovery tag, instead of the unit file's");
  app.add_option("--security", options.security,
                 "folder of keys, as `mpm keys` makes, instead of the unit file's; taken are those "
                 "of the gateway");
  app.footer(
      "Examples:\n"
      "  mpmsim --config shell3x3.yaml --scenario hidden_gain --seed 7 --csv run.csv\n"
      "  mpmsim --config shell3x3.yaml --scenario s3_delay --speed 10\n"
      "  mpmsim --config shell3x3.yaml --bad-data missing=5% --csv run.csv\n"
      "  mpmsim --config shell3x3.yaml --limits 20\n"
      "Exit codes: 0 done, 2 the run failed, 3 bad usage or bad input");
}

}  // namespace mpm::sim
