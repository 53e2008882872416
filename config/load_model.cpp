#include <algorithm>

#include "config/load_model_parts.hpp"
#include "core/text/number_text.hpp"

namespace mpm::config {
namespace {

/// A digit too many: what lies outside by more than the limits are apart is hardly an operating
/// point. (CVs may rest outside theirs, which are soft.)
void warn_if_far_outside(const Value& place, double value, const SignalLimits& limits) {
  if (!limits.low || !limits.high) return;
  const double span = *limits.high - *limits.low;
  if (value >= *limits.low - span && value <= *limits.high + span) return;
  place.warning("lies far outside the signal's own limits, " + number_text(*limits.low) + " to " +
                number_text(*limits.high));
}

void load_origin(const Value& section, UnitConfig& config) {
  std::vector<std::string> tags = config.input_tags();
  const int input_count = static_cast<int>(tags.size());
  for (const std::string& tag : config.cv_tags()) tags.push_back(tag);
  const Map map = section.map(tags, "tag");
  for (const Map::Entry& entry : map.entries()) {
    const int index =
        static_cast<int>(std::find(tags.begin(), tags.end(), entry.key) - tags.begin());
    const double value = entry.value.number().value_or(0.0);
    if (index < input_count) {
      config.model.input_origin(index) = value;
      if (static_cast<std::size_t>(index) < config.mv.size())
        warn_if_far_outside(entry.value, value, config.mv[static_cast<std::size_t>(index)].limits);
    } else {
      config.model.output_origin(index - input_count) = value;
    }
  }
}

/// A CV that nothing drives is simulated as a constant: allowed, but hardly ever meant.
void warn_of_idle_cvs(const Value& section, const UnitConfig& config) {
  if (config.model.state_space) return;
  for (std::size_t j = 0; j < config.cv.size(); ++j) {
    const auto drives = [j](const ChannelSpec& channel) {
      return channel.cv == static_cast<int>(j);
    };
    if (!config.cv[j].tag.empty() &&
        std::none_of(config.model.channels.begin(), config.model.channels.end(), drives))
      section.warning("no channel leads to cv '" + config.cv[j].tag + "'");
  }
}

void check_missing_model(const Value* section, const Value& place, const UnitConfig& config) {
  std::string without;
  for (const CvSignal& cv : config.cv)
    if (cv.prediction.empty() && !cv.tag.empty()) without += (without.empty() ? "" : ", ") + cv.tag;
  const std::string what = section == nullptr ? "`model` is missing" : "holds no model";
  if (without.empty()) {
    place.warning(what + "; predictions must come with the data");
  } else {
    place.error(what + " and these have no prediction tag: " + without);
  }
}

void load_terms(const Map& map, UnitConfig& config) {
  const ModelSignals signals = signals_of(config);
  if (const Value* terms = map.find("state"); terms != nullptr && !terms->is_null()) {
    if (config.model.state_space)
      terms->error("goes with `channels`, not with `state_space`");
    else
      config.model.state_terms = read_state_terms(*terms, signals, config.model.channels);
  }
  if (const Value* list = map.find("disturbances"); list != nullptr && !list->is_null())
    config.model.disturbances = read_disturbances(*list, signals);
}

}  // namespace

ModelSignals signals_of(const UnitConfig& unit) {
  return {unit.input_tags(), unit.cv_tags(), unit.model.input_origin, unit.model.output_origin,
          unit.sample_time_s};
}

void load_model(const Value& root, const Value* section, const Value* top_level_origin,
                ModelNeed need, UnitConfig& config) {
  ModelSpec& model = config.model;
  model.sample_time_s = config.sample_time_s;
  model.input_count = config.counts().inputs();
  model.cv_count = config.counts().cv;
  const auto inputs = static_cast<std::size_t>(model.input_count);
  const auto cvs = static_cast<std::size_t>(model.cv_count);
  model.input_blocks.resize(inputs);
  model.output_blocks.resize(cvs);
  model.input_origin.setZero(model.input_count);
  model.output_origin.setZero(model.cv_count);

  if (top_level_origin != nullptr) load_origin(*top_level_origin, config);
  bool tried = false;
  if (section != nullptr && !(section->is_null() && need == ModelNeed::kMayBeMissing)) {
    const Map map = section->map(
        {"channels", "state_space", "input", "output", "state", "disturbances", "operating_point"});
    if (const Value* inner = map.find("operating_point")) {
      if (top_level_origin != nullptr) inner->error("given twice; also at the top level");
      load_origin(*inner, config);  // first: tanks ask what it is
    }
    const Value* channels = map.find("channels");
    const Value* state_space = map.find("state_space");
    if (channels != nullptr && state_space != nullptr)
      state_space->error("give either `channels` or `state_space`, not both");
    tried = (channels != nullptr && !channels->is_null()) || state_space != nullptr;
    if (channels != nullptr && !channels->is_null())
      model.channels = read_channels(*channels, signals_of(config));
    if (state_space != nullptr)
      load_state_space(state_space->map({"A", "B", "C", "D", "x0"}), config);
    if (const Value* blocks = map.find("input"))
      read_input_blocks(*blocks, config.input_tags(), model.input_blocks);
    if (const Value* blocks = map.find("output"))
      read_output_blocks(*blocks, config.cv_tags(), model.output_blocks);
    load_terms(map, config);
    // Not where a channel could not be read: that has been told, and may be the one.
    if (channels != nullptr && tried && model.channels.size() == channels->items().size())
      warn_of_idle_cvs(*section, config);
  }
  if (!tried && need == ModelNeed::kNeeded)
    check_missing_model(section, section != nullptr ? *section : root, config);
}

}  // namespace mpm::config
