#include <sstream>

#include "config/load_unit.hpp"
#include "core/model/linear_model.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/fuzz/tolerate.hpp"

namespace mpm::fuzz {

// What is sound is printed, and reads back to the same: so the daemon's state knows its unit by.
void unit_file(std::string_view bytes) {
  const config::LoadResult loaded = config::load_unit_text(std::string(bytes), "m.yaml");
  for (const config::Finding& finding : loaded.findings) {
    require(finding.file == "m.yaml" && finding.line >= 0 && !finding.message.empty(),
            "a finding without a place or a message");
    static_cast<void>(config::format(finding));
  }
  if (!loaded.ok()) return;
  static_cast<void>(LinearModel(loaded.config.model));
  std::ostringstream once, twice;
  config::print_unit(loaded.config, once);
  const config::LoadResult again = config::load_unit_text(once.str(), "again.yaml");
  require(again.ok(), "what was printed is no unit file");
  config::print_unit(again.config, twice);
  require(once.str() == twice.str(), "what was printed reads back to something else");
}

}  // namespace mpm::fuzz
