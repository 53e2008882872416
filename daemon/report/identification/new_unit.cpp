#include "daemon/report/identification/new_unit.hpp"

#include <sstream>
#include <stdexcept>

#include "config/load_unit.hpp"
#include "core/identification/identify_long.hpp"
#include "core/text/printable.hpp"

namespace mpm::report {
namespace {

/// Without the top-level sections that a model stands in: from their key to the next line that
/// begins another one. `at` becomes where the first of them stood.
std::string without_model(const std::string& text, std::size_t& at) {
  std::istringstream lines(text);
  std::string kept, held;  // held: comments and blank lines, which belong to what follows
  bool inside = false;
  at = std::string::npos;
  for (std::string line; std::getline(lines, line);) {
    const bool passive = line.empty() || line[0] == '#';
    const bool top = !passive && line[0] != ' ' && line[0] != '\t' && line[0] != '-' &&
                     line[0] != '}' && line[0] != ']' && line[0] != '\r';
    if (top) {
      inside = line.starts_with("model:") || line.starts_with("operating_point:");
      if (inside && at == std::string::npos) at = kept.size();
    }
    if (passive) {
      held += line + '\n';
      continue;
    }
    if (!inside || top) kept += held;
    held.clear();
    if (!inside) kept += line + '\n';
  }
  kept += held;
  if (at == std::string::npos) at = kept.size();
  return kept;
}

std::string header(const IdentificationRun& run) {
  return "# The model was identified by " + run.program + " from " +
         printable(run.data_file, std::string::npos) + ".\n";
}

bool loads(const std::string& text, const IdentificationRun& run) {
  const config::LoadResult back = config::load_unit_text(text, run.out_file);
  return back.ok() && back.config.input_tags() == run.unit.input_tags() &&
         back.config.cv_tags() == run.unit.cv_tags() &&
         back.config.model.channels.size() == run.identification.model.channels.size();
}

}  // namespace

std::string new_unit_yaml(const IdentificationRun& run, const std::string& text) {
  config::UnitConfig unit = run.unit;
  unit.model = model_at(run.identification, unit.sample_time_s);
  std::ostringstream model, all;
  config::print_model_section(unit, model);
  std::size_t at = 0;
  std::string result = without_model(text, at);
  result.insert(at, header(run) + model.str());
  if (loads(result, run)) return result;
  // Written in another style than one section below the other: as the program sees it.
  all << header(run);
  config::print_unit(unit, all);
  if (!loads(all.str(), run)) throw std::logic_error("the identified model does not load back");
  return all.str();
}

}  // namespace mpm::report
