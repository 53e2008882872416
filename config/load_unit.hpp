#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "config/unit_config.hpp"

namespace mpm::config {

/// The unit as far as it could be read, and everything that is wrong with its file. The config may
/// be used only if ok().
struct LoadResult {
  UnitConfig config;
  std::vector<Finding> findings;  ///< in the order of the file

  [[nodiscard]] bool ok() const { return !has_errors(findings); }
};

/// Several unit files; `units` holds one result's config per file, in the order of the files.
struct LoadUnitsResult {
  std::vector<UnitConfig> units;
  std::vector<Finding> findings;

  [[nodiscard]] bool ok() const { return !has_errors(findings); }
};

/// Whether a unit may do without a model and without predictions: only who makes one allows it.
enum class ModelNeed { kNeeded, kMayBeMissing };

/// Reads and checks one unit file (interfaces: "Unit file"). Never throws on what the file holds.
[[nodiscard]] LoadResult load_unit(const std::string& path, ModelNeed need = ModelNeed::kNeeded);

/// The same from text; `name` stands for the file in the findings.
[[nodiscard]] LoadResult load_unit_text(const std::string& text, const std::string& name,
                                        ModelNeed need = ModelNeed::kNeeded);

/// Reads all files or folders; two files with the same unit name are an error.
[[nodiscard]] LoadUnitsResult load_units(const std::vector<std::string>& paths);

/// `path` itself, or, if it is a folder, its *.yaml and *.yml files, sorted by name.
[[nodiscard]] std::vector<std::string> unit_files(const std::string& path);

/// The effective configuration, defaults included, as a unit file that loads back to an equal one.
void print_unit(const UnitConfig& config, std::ostream& out);

}  // namespace mpm::config
