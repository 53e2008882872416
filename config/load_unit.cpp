#include "config/load_unit.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>

#include "config/choice.hpp"
#include "config/default_movement.hpp"
#include "config/failure_text.hpp"
#include "config/load_sections.hpp"
#include "core/monitor/cost.hpp"
#include "core/text/number_text.hpp"

namespace mpm::config {
namespace {

constexpr std::size_t kLongestUnitName = 128;

void load_name(const Map& root, UnitConfig& config) {
  const Value* value = root.require("unit");
  if (value == nullptr) return;
  const std::optional<std::string> name = value->text(kLongestUnitName);
  if (!name) return;
  if (name->find('/') != std::string::npos) {
    value->error("must not hold '/', since files are named after the unit");
    return;
  }
  if (*name == "." || *name == "..") {
    value->error("must not be '" + *name + "', since files are named after the unit");
    return;
  }
  config.unit = *name;
}

constexpr double kMostBytes = 16e9;

/// What the usual nonlinear test would take, where it would keep up and another one is chosen.
std::string faster_test(const UnitConfig& config) {
  MonitorSettings usual = config.monitor;
  usual.nonlinear = MonitorSettings{}.nonlinear;
  const double seconds = monitor_cost(config.model, usual).seconds;
  if (config.monitor.nonlinear == NonlinearTest::kOff || seconds > config.sample_time_s) return "";
  return "; with `nonlinear: " + name_of(usual.nonlinear) + "` about " + number_text(seconds) +
         " s, and `mpm detect --nonlinear " + name_of(config.monitor.nonlinear) +
         "` asks what is recorded";
}

/// Whether the usual memory would be room enough: a unit whose size is in its signals is not made
/// smaller by a shorter one.
bool has_long_memory(const UnitConfig& config) {
  MonitorSettings usual = config.monitor;
  usual.memory_s = MonitorSettings{}.memory_s;
  usual.fast_memory_s = MonitorSettings{}.fast_memory_s;
  return monitor_cost(config.model, usual).bytes <= kMostBytes;
}

/// A unit that no machine has room for is refused where its size comes from; one that is too slow
/// to keep up is told.
void check_cost(const Map& root, const UnitConfig& config) {
  const MonitorCost cost = monitor_cost(config.model, config.monitor);
  const Value* monitor = root.find("monitor");
  const Value* cause = monitor != nullptr ? monitor : root.find("model");
  if (cause == nullptr) cause = root.find("signals");
  const std::string size = number_text(cost.columns) + " regression columns for each of " +
                           counted(config.cv.size(), "CV") + ", " + number_text(cost.remembered) +
                           " samples remembered";
  if (cost.bytes > kMostBytes)
    cause->error("the monitor of this unit would need " + number_text(1e-9 * cost.bytes) +
                 " GB of memory (" + size + "); " +
                 (has_long_memory(config) ? "shorten its memory" : "split the unit"));
  else if (cost.seconds > config.sample_time_s)
    cause->warning("the monitor of this unit would take about " + number_text(cost.seconds) +
                   " s of every " + number_text(config.sample_time_s) + " s sample (" + size + ")" +
                   faster_test(config));
}

void load_root(const Value& document, ModelNeed need, Report& report, UnitConfig& config) {
  if (!document.is_map()) {
    document.error("a unit file is a map of keys such as `unit:` and `signals:`");
    return;
  }
  const Map root = document.map({"unit", "sample_time", "signals", "model", "operating_point",
                                 "monitor", "alarms", "dds", "simulation", "identify"});
  load_name(root, config);
  if (const Value* sample_time = root.require("sample_time"))
    config.sample_time_s = sample_time->number(kPositive).value_or(1.0);
  const Value* signals = root.require("signals");
  load_signals(signals, config);
  // Without signals everything below would only complain about unknown tags.
  if (config.mv.empty() || config.cv.empty()) return;
  load_model(document, root.find("model"), root.find("operating_point"), need, config);
  load_monitor(root.find("monitor"), config, config.monitor);
  load_alarms(root.find("alarms"), config);
  load_dds(root.find("dds"), config);
  load_simulation(root.find("simulation"), config);
  load_identify(root.find("identify"), config);
  if (report.has_error()) return;
  check_cost(root, config);
  const Value* simulation = root.find("simulation");
  if (simulation == nullptr || simulation->is_null()) give_default_movement(config);
}

void load_text(const std::string& text, ModelNeed need, Report& report, UnitConfig& config) {
  if (const std::optional<Value> document = parse_yaml(text, report))
    load_root(*document, need, report, config);
}

}  // namespace

LoadResult load_unit(const std::string& path, ModelNeed need) {
  LoadResult result;
  Report report(path);
  if (const std::optional<std::string> text = read_text_file(path, report))
    load_text(*text, need, report, result.config);
  result.findings = report.take();
  return result;
}

LoadResult load_unit_text(const std::string& text, const std::string& name, ModelNeed need) {
  LoadResult result;
  Report report(name);
  load_text(text, need, report, result.config);
  result.findings = report.take();
  return result;
}

std::vector<std::string> unit_files(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code failure;
  if (!fs::is_directory(path, failure)) return {path};
  std::vector<std::string> files;
  for (fs::directory_iterator entry(path, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const fs::path& file = entry->path();
    const bool hidden = file.filename().string().front() == '.';
    if (!hidden && (file.extension() == ".yaml" || file.extension() == ".yml"))
      files.push_back(file.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

namespace {

std::string why_none(const std::string& folder) {
  std::error_code failure;
  (void)std::filesystem::directory_iterator(folder, failure);
  return failure ? "cannot be read: " + failure_text(failure.value())
                 : "the folder holds no unit file (*.yaml, *.yml)";
}

}  // namespace

LoadUnitsResult load_units(const std::vector<std::string>& paths) {
  LoadUnitsResult result;
  std::map<std::string, std::string> file_of_unit;
  for (const std::string& path : paths) {
    const std::vector<std::string> files = unit_files(path);
    if (files.empty())
      result.findings.push_back({path, 0, 0, Severity::kError, "", why_none(path)});
    for (const std::string& file : files) {
      // Of a folder nobody has named it: a pipe would be waited for without end.
      std::error_code failure;
      if (file != path && std::filesystem::is_other(file, failure)) {
        result.findings.push_back({file, 0, 0, Severity::kError, "", "is no file"});
        continue;
      }
      LoadResult one = load_unit(file);
      result.findings.insert(result.findings.end(), one.findings.begin(), one.findings.end());
      if (!one.config.unit.empty()) {
        const auto [first, is_new] = file_of_unit.emplace(one.config.unit, file);
        if (!is_new)
          result.findings.push_back(
              {file, 1, 1, Severity::kError, "unit",
               "'" + one.config.unit + "' is already the unit of " + first->second});
      }
      result.units.push_back(std::move(one.config));
    }
  }
  return result;
}

}  // namespace mpm::config
