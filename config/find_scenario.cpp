#include <algorithm>
#include <filesystem>
#include <system_error>

#include "config/scenario_config.hpp"
#include "config/suggest.hpp"

namespace mpm::config {
namespace fs = std::filesystem;

std::string find_scenario(const std::string& name, const std::string& unit_file) {
  const fs::path as_path(name);
  if (as_path.extension() == ".yaml" || as_path.extension() == ".yml") return name;
  const fs::path beside = fs::path(unit_file).parent_path();
  std::vector<std::string> known;
  for (const fs::path& folder :
       {beside / "scenarios", beside / ".." / "scenarios", fs::path(MPM_SCENARIO_DIR)}) {
    std::error_code failure;
    const fs::path file = folder / (name + ".yaml");
    if (!name.empty() && fs::is_regular_file(file, failure))
      return file.lexically_normal().string();
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
         entry.increment(failure))
      if (entry->path().extension() == ".yaml") known.push_back(entry->path().stem().string());
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  std::string message = "unknown scenario '" + name + "'" + suggestion(name, known);
  if (message.find("known:") == std::string::npos && !known.empty())
    message += "; known: " + join(known, known.size());
  throw InputError({"", 0, 0, Severity::kError, "", message});
}

}  // namespace mpm::config
