#include "tests/boiler/unit_texts.hpp"

#include <algorithm>
#include <sstream>

#include "config/load_unit.hpp"
#include "config/scenario_config.hpp"
#include "core/model/linear_model.hpp"
#include "tests/boiler/samples.hpp"
#include "tests/boiler/workshop.hpp"
#include "tests/system/process.hpp"

namespace mpm::boiler {
namespace {

bool is_named(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The value of a key that begins a line of its own.
std::string value_of(const std::string& text, const std::string& key) {
  for (const std::string& line : test::lines_of(text))
    if (line.starts_with(key + ": ")) return line.substr(key.size() + 2);
  return {};
}

/// From its key to the end: a scenario file's last section.
std::string last_section(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key + ":\n");
  if (at == std::string::npos) throw StoryError("a scenario without " + key);
  return text.substr(at);
}

/// CV at which the model of `unit` rests with these inputs.
double level_at(const config::UnitConfig& unit, int cv, const Eigen::VectorXd& inputs) {
  LinearModel model(unit.model);
  model.reset_steady(inputs);
  return model.output()(cv);
}

}  // namespace

std::string tags_alone(const std::string& text, const std::vector<std::string>& cvs) {
  std::string kept, section, list;
  for (const std::string& line : test::lines_of(text)) {
    if (line.starts_with('#')) continue;  // of a model that goes
    if (!line.empty() && line[0] != ' ') section = line.substr(0, line.find(':'));
    if (line.ends_with(':')) list = line;
    if (section == "model" || (section == "simulation" && !cvs.empty())) continue;
    const std::size_t tag = line.find("{tag: ");
    if (!cvs.empty() && section == "signals" && list == "  cv:" && tag != std::string::npos &&
        !is_named(cvs, line.substr(tag + 6, line.find(',', tag) - tag - 6)))
      continue;
    kept += line + '\n';
  }
  return kept;
}

std::string with_channels_of(const std::string& old_file, const std::string& new_file,
                             const std::vector<std::string>& cvs) {
  config::UnitConfig unit = unit_of(old_file);
  const config::UnitConfig other = unit_of(new_file);
  std::erase_if(unit.model.channels, [&](const ChannelSpec& channel) {
    return is_named(cvs, unit.cv[static_cast<std::size_t>(channel.cv)].tag);
  });
  const std::vector<std::string> tags = unit.cv_tags();
  for (ChannelSpec channel : other.model.channels) {
    const int theirs = channel.cv;
    const auto at =
        std::find(tags.begin(), tags.end(), other.cv_tags()[static_cast<std::size_t>(theirs)]);
    channel.cv = static_cast<int>(at - tags.begin());
    if (!is_named(cvs, *at)) continue;
    unit.model.channels.push_back(channel);
    // Both files have operating points of their own.
    unit.model.output_origin(channel.cv) = level_at(other, theirs, unit.model.input_origin);
  }
  std::ostringstream model;
  config::print_model_section(unit, model);
  return tags_alone(test::read_file(old_file)) + model.str();
}

std::string test_on_changed_plant(const std::string& tests, const std::string& changed) {
  return "scenario: test_on_changed_plant\n" + last_section(changed, "process") +
         last_section(tests, "tests");
}

std::string resting_at(const std::string& file, const std::vector<double>& mvs,
                       const std::string& scenario) {
  config::UnitConfig unit = unit_of(file);
  std::vector<double> sizes(mvs.size(), 0.0);
  for (const config::TestSignal& test : config::load_scenario(scenario, unit).scenario.tests)
    for (std::size_t i = 0; i < mvs.size(); ++i)
      if (unit.mv[i].tag == test.mv) sizes[i] = std::max(sizes[i], test.size);
  for (std::size_t i = 0; i < mvs.size(); ++i) {
    const SignalLimits limits = unit.mv_limits(i);
    double& at = unit.model.input_origin(static_cast<Eigen::Index>(i));
    at = mvs[i];
    if (limits.low) at = std::max(at, *limits.low + sizes[i]);
    if (limits.high) at = std::min(at, *limits.high - sizes[i]);
  }
  std::ostringstream text;
  config::print_unit(unit, text);
  return text.str();
}

std::string description_of(const std::string& scenario) {
  return value_of(scenario, "description");
}

}  // namespace mpm::boiler
