#include "daemon/report/diagnosis/extended_unit.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "config/load_unit.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/report/diagnosis/explain.hpp"

namespace mpm::report {
namespace {

constexpr std::size_t kLineWidth = 96;

/// Text as comment lines; words are kept whole, control characters out of the file.
std::string comment(const std::string& text, const std::string& indent) {
  std::string lines;
  std::string line = "# ";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > kLineWidth) {
      lines += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
      line = "# " + indent;
    }
    line += word + ' ';
  }
  return lines + line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
}

/// A path, in which any byte may stand.
std::string in_full(const std::string& path) { return printable(path, std::string::npos); }

std::string header(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  std::string text = comment("Written by " + run.program + " from " + in_full(run.config_file) +
                                 " and " + in_full(run.data_file) + ".",
                             "");
  text += comment(verdict_sentence(run), "");
  if (diagnosis.findings.empty()) return text + comment("The model is the unit file's own.", "");
  text +=
      comment("What was found, most important first; what could be repaired is in `model`:", "");
  for (const Finding& finding : diagnosis.findings)
    text += comment("- " + explain(run, finding), "  ");
  const auto& was = run.unit.model.state_space;
  const auto& is = diagnosis.extended.state_space;
  if (was && is && is->a.rows() > was->a.rows())
    text += comment("The state space is the unit file's own, with " +
                        counted(static_cast<std::uint64_t>(is->a.rows() - was->a.rows()), "state") +
                        " added for what the repaired channels give more or less than before.",
                    "");
  if (was && !is)
    text += comment(
        "The state space is given as the step responses of its channels: the repair is not linear, "
        "or would take too many states.",
        "");
  for (const int aux : diagnosis.new_inputs)
    text += comment("- " + run.unit.aux.at(static_cast<std::size_t>(aux)).tag +
                        " was under `aux`; the model takes it now as a DV.",
                    "  ");
  return text;
}

}  // namespace

config::UnitConfig extended_unit(const config::UnitConfig& unit, const Diagnosis& diagnosis) {
  config::UnitConfig extended = unit;
  extended.model = diagnosis.extended;
  // The recorded predictions are the old model's: whoever reads this file simulates.
  if (!diagnosis.findings.empty())
    for (config::CvSignal& cv : extended.cv) cv.prediction.clear();
  const auto new_count = diagnosis.new_inputs.size();
  const int expected = unit.counts().inputs() + static_cast<int>(new_count);
  if (extended.model.input_count != expected || extended.model.cv_count != unit.counts().cv)
    throw std::logic_error("the extended model has " + std::to_string(extended.model.input_count) +
                           " inputs, the unit with the new ones " + std::to_string(expected));
  for (const int aux : diagnosis.new_inputs) {
    const auto i = static_cast<std::size_t>(aux);
    extended.dv.push_back(unit.aux.at(i));
    extended.simulation.dv_movement.push_back(unit.simulation.aux_movement.at(i));
  }
  std::vector<int> taken = diagnosis.new_inputs;
  std::sort(taken.rbegin(), taken.rend());  // from the end, so that indices stay right
  for (const int aux : taken) {
    extended.aux.erase(extended.aux.begin() + aux);
    std::vector<config::NoiseSettings>& movement = extended.simulation.aux_movement;
    movement.erase(movement.begin() + aux);
  }
  return extended;
}

std::string own_inputs_yaml(const config::UnitConfig& unit, const Diagnosis& diagnosis) {
  config::UnitConfig own = unit;
  const int inputs = unit.counts().inputs();
  own.model = diagnosis.extended;
  own.model.input_count = inputs;
  own.model.input_blocks.resize(static_cast<std::size_t>(inputs));
  own.model.input_origin.conservativeResize(inputs);
  if (own.model.state_space) {
    StateSpaceSpec& system = *own.model.state_space;
    system.b.conservativeResize(Eigen::NoChange, inputs);
    system.d.conservativeResize(Eigen::NoChange, inputs);
  }
  const auto is_new = [inputs](const auto& part) { return part.input >= inputs; };
  std::erase_if(own.model.channels, is_new);
  std::erase_if(own.model.state_terms, is_new);
  std::ostringstream out;
  config::print_unit(own, out);
  return out.str();
}

std::string extended_yaml(const DiagnosisRun& run) {
  const config::UnitConfig unit = extended_unit(run.unit, run.diagnosis);
  std::ostringstream out;
  out << header(run);
  config::print_unit(unit, out);
  const config::LoadResult back = config::load_unit_text(out.str(), "extended.yaml");
  for (const config::Finding& finding : back.findings)
    if (finding.severity == config::Severity::kError)
      throw std::logic_error("the extended model does not load back: " + config::format(finding));
  return out.str();
}

}  // namespace mpm::report
