#include "daemon/report/closed_loop/compare_loops.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/report/closed_loop/loop_tally.hpp"
#include "daemon/report/closed_loop/run_mpmsim.hpp"
#include "daemon/report/diagnosis/extended_unit.hpp"

namespace mpm::report {
namespace {

constexpr int kSamples = 3000;
constexpr std::chrono::seconds kLongestRun{120};
constexpr std::uint64_t kFreshSeeds = 900'001;  // the first of three that nobody's data came from

/// A folder for the runs' files that goes away with this object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "mpm-diagnose-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw SimulatorError("no folder for the runs: " + name);
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

void run_once(const LoopPlan& plan, const config::UnitConfig& unit, const std::string& csv,
              std::uint64_t seed, const std::string& controller_file,
              const std::function<bool()>& stopped, LoopTally& tally) {
  std::vector<std::string> arguments = {"--config",   plan.config,
                                        "--scenario", plan.scenario,
                                        "--samples",  std::to_string(kSamples),
                                        "--seed",     std::to_string(seed),
                                        "--csv",      csv};
  if (!controller_file.empty())
    arguments.insert(arguments.end(), {"--controller-model", controller_file});
  run_mpmsim(plan.program, arguments, kLongestRun, stopped);
  files::CsvReader reader(csv, unit);
  Frame frame(unit.counts());
  while (reader.next(frame)) tally.add(frame);
}

}  // namespace

std::optional<LoopPlan> plan_loops(const config::UnitConfig& unit, const std::string& config_file,
                                   const std::string& scenario, std::optional<std::uint64_t> seed,
                                   std::vector<config::Finding>& findings) {
  LoopPlan plan;
  plan.program = find_mpmsim();
  plan.config = config_file;
  plan.scenario = scenario;
  const std::string file = config::find_scenario(scenario, config_file);
  config::ScenarioResult loaded = config::load_scenario(file, unit, kSamples * unit.sample_time_s);
  findings = loaded.findings;
  if (!loaded.ok()) return std::nullopt;
  plan.loaded = std::move(loaded.scenario);
  if (!plan.loaded.draw) {
    plan.seeds = {kFreshSeeds, kFreshSeeds + 1, kFreshSeeds + 2};
  } else if (seed) {
    plan.seeds = {*seed};  // any other would hide something else
  } else {
    throw config::InputError(
        {file, 0, 0, config::Severity::kError, "",
         "draws what it hides from the seed: say with --seed which one made the data"});
  }
  return plan;
}

ClosedLoop compare_loops(const LoopPlan& plan, const config::UnitConfig& unit,
                         const Diagnosis& diagnosis, const std::function<bool()>& stopped) {
  const ScratchFolder folder;
  const std::string csv = folder.file("run.csv");
  const std::string controller = folder.file("controller.yaml");
  std::ofstream(controller, std::ios::binary) << own_inputs_yaml(unit, diagnosis);
  const std::vector<config::MvLimits> limits = limits_in(unit, plan.loaded);
  LoopTally before(unit, limits), after(unit, limits);
  for (const std::uint64_t seed : plan.seeds) {
    run_once(plan, unit, csv, seed, "", stopped, before);
    run_once(plan, unit, csv, seed, controller, stopped, after);
  }
  ClosedLoop result;
  result.scenario = plan.scenario;
  result.seeds = plan.seeds;
  result.samples = kSamples;
  for (const int aux : diagnosis.new_inputs)
    result.inputs_left_out.push_back(unit.aux.at(static_cast<std::size_t>(aux)).tag);
  for (int cv = 0; cv < unit.counts().cv; ++cv)
    result.cvs.push_back({cv, before.error_variance(cv), after.error_variance(cv)});
  for (int mv = 0; mv < unit.counts().mv; ++mv)
    result.mvs.push_back({mv, before.at_limit(mv), after.at_limit(mv)});
  return result;
}

}  // namespace mpm::report
