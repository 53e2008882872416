// Fits the fitted constants of the mismatch test again, on seeds that score nothing, and prints
// them beside those in use. Which are taken over is for a person to say: what the monitor says of
// every plant moves with them.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "tests/calibrate/readings.hpp"
#include "tests/calibrate/refit.hpp"

namespace mpm::calibrate {
namespace {

struct Options {
  std::vector<std::string> plants;
  int seeds = 0;
  int threads = 0;
  bool short_version = false;
};

std::vector<Refit> refit_all(const std::vector<Run>& normal, const std::vector<Run>& heavy) {
  constexpr double kTolerance = 2.0;
  const int fewest = static_cast<int>(calibration::rows_needed::kPerColumn);
  std::vector<Refit> refits;
  const auto add = [&](Refit refit, const char* name, double now, const char* rule) {
    refit.name = name;
    refit.now = now;
    refit.rule = rule;
    refits.push_back(refit);
  };
  add(refit_few_rows(normal, Test::kDirected, fewest, 2 * fewest), "few_rows::kDirected",
      calibration::few_rows::kDirected, "p < 0.05 in 5 % of the tests of the usual errors");
  add(refit_few_rows(normal, Test::kBlock, fewest, 2 * fewest), "few_rows::kBlock",
      calibration::few_rows::kBlock, "p < 0.05 in 5 % of the tests of the whole block");
  add(refit_rows_needed(normal, 1e-3, kTolerance), "rows_needed::kPerColumn",
      calibration::rows_needed::kPerColumn, "from there on p < 0.001 at most twice too often");
  add(refit_rows_needed(heavy, 1e-3, kTolerance), "rows_needed::kPerColumn",
      calibration::rows_needed::kPerColumn, "the same with heavy tails");
  add(refit_clipped_share(normal, 0.99), "heavy_tails::kFromShare",
      calibration::heavy_tails::kFromShare, "99 % of CVs with normal noise have less");
  add(refit_clipped_share(heavy, 0.05), "heavy_tails::kFullShare",
      calibration::heavy_tails::kFullShare, "95 % of CVs with heavy tails have more");
  return refits;
}

int run(const Options& options) {
  Loops loops{.plants = options.plants,
              .scenario = "none",
              .seeds = options.seeds,
              .threads = options.threads};
  if (loops.plants.empty()) {
    loops.plants = {"shell3x3", "wood_berry", "ogunnaike_ray", "integrating_tank"};
    if (!options.short_version) loops.plants.emplace_back("shell7x5");
  }
  if (loops.seeds == 0) loops.seeds = options.short_version ? 20 : 300;
  if (loops.threads == 0) loops.threads = static_cast<int>(std::thread::hardware_concurrency());
  const std::vector<Run> normal = read_loops(loops);
  loops.scenario = "heavy_tails";
  const std::vector<Run> heavy = read_loops(loops);

  std::cout << "Seeds from " << loops.first_seed << " on, " << loops.seeds
            << " of each plant. Shares of healthy channels\n\nnormal noise\n\n"
            << tail_table(normal, {0.05, 1e-2, 1e-3, 1e-4}) << "\nheavy tails\n\n"
            << tail_table(heavy, {0.05, 1e-2, 1e-3, 1e-4})
            << "\n| constant | now | refitted | 95 % interval | rule |\n|---|---|---|---|---|\n";
  bool strict = true;
  for (const Refit& refit : refit_all(normal, heavy)) {
    std::printf("| %s | %.4g | %.4g | %.4g to %.4g | %s |\n", refit.name.c_str(), refit.now,
                refit.fitted, refit.low, refit.high, refit.rule.c_str());
    strict = strict && !refit.too_lax();
  }
  if (!strict) std::cerr << "a constant allows more false alarms than it should\n";
  return strict ? 0 : 1;
}

}  // namespace
}  // namespace mpm::calibrate

int main(int argc, char** argv) {
  try {
    CLI::App app(
        "Fits the constants of the mismatch test again and prints old beside new; fails where one "
        "in use allows more false alarms than it should.");
    mpm::calibrate::Options options;
    app.add_option("--plants", options.plants, "files in config/plants");
    app.add_option("--seeds", options.seeds, "of each plant, from 100001 on")
        ->check(CLI::PositiveNumber);
    app.add_option("--threads", options.threads, "instead of one per core")
        ->check(CLI::PositiveNumber);
    app.add_flag("--short", options.short_version, "few seeds; ctest runs it");
    CLI11_PARSE(app, argc, argv);
    return mpm::calibrate::run(options);
  } catch (const std::exception& error) {
    std::cerr << "mpm_calibrate: " << error.what() << '\n';
    return 2;
  }
}
