#include "config/load_scenario_parts.hpp"

#include <cmath>

#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

std::vector<std::string> mv_tags(const UnitConfig& unit) {
  std::vector<std::string> tags = unit.input_tags();
  tags.resize(unit.mv.size());
  return tags;
}

constexpr Range kShare{.low = 0.0, .high = 1.0};

struct KindKey {
  const char* key;
  DisturbanceKind kind;
  Range size;
};
constexpr KindKey kKinds[] = {
    {"step", DisturbanceKind::kStep, kAny},
    {"ramp", DisturbanceKind::kRamp, kAny},
    {"drift", DisturbanceKind::kDrift, kNotNegative},
    {"periodic", DisturbanceKind::kPeriodic, kNotNegative},
    {"sensor_noise", DisturbanceKind::kSensorNoise, kNotNegative},
};

std::vector<std::string> keys_of(DisturbanceKind kind) {
  switch (kind) {
    case DisturbanceKind::kStep:
      return {"time_constant"};
    case DisturbanceKind::kRamp:
      return {"duration"};
    case DisturbanceKind::kDrift:
      return {"pole"};
    case DisturbanceKind::kPeriodic:
      return {"period", "phase"};
    case DisturbanceKind::kSensorNoise:
      return {};
  }
  return {};
}

/// What only some kinds have.
void read_shape(const Map& map, const ScenarioContext& context, Disturbance& disturbance) {
  if (const Value* value = map.find("time_constant"))
    disturbance.time_constant_s = read_time(*value, context).value_or(0.0);
  if (disturbance.kind == DisturbanceKind::kRamp)
    if (const Value* value = map.require("duration"))
      disturbance.duration_s = read_time(*value, context, kPositive).value_or(1.0);
  if (const Value* value = map.find("pole"))
    disturbance.pole = value->number({.low = 0, .high = 1, .high_open = true}).value_or(0.999);
  if (disturbance.kind == DisturbanceKind::kPeriodic)
    if (const Value* value = map.require("period"))
      disturbance.period_s = read_time(*value, context, kPositive).value_or(1.0);
  if (const Value* value = map.find("phase"))
    disturbance.phase_degrees = value->number().value_or(0.0);
}

}  // namespace

std::optional<double> read_time(const Value& value, const ScenarioContext& context,
                                const Range& range) {
  const std::optional<Quantity> time = value.quantity({"samples", "s", "%"}, range);
  if (!time) return std::nullopt;
  if (time->unit == "samples") return time->number * context.unit.sample_time_s;
  if (time->unit != "%") return time->number;
  if (time->number > 100.0) {
    value.error("must be <= 100 % of the run, not " + yaml_text(time->number));
    return std::nullopt;
  }
  if (context.run_s) return time->number / 100.0 * *context.run_s;
  value.error("a share of the run, but the length of the run is not given (--samples)");
  return std::nullopt;
}

void read_span(const Map& map, const ScenarioContext& context, double& from_s, double& until_s) {
  if (const Value* from = map.find("from")) from_s = read_time(*from, context).value_or(0.0);
  const Value* until = map.find("until");
  if (until == nullptr) return;
  const std::optional<double> end = read_time(*until, context);
  if (!end) return;
  until_s = *end;
  if (until_s <= from_s) until->error("must be after `from`");
}

double noise_deviation(const ScenarioContext& context, int cv, const Value& value) {
  const auto index = static_cast<std::size_t>(cv);
  const std::vector<NoiseSettings>& noise = context.unit.simulation.noise;
  const double deviation =
      index < noise.size()
          ? noise[index].sigma / std::sqrt(1.0 - noise[index].pole * noise[index].pole)
          : 0.0;
  if (deviation == 0.0)
    value.error("the unit file gives " + context.unit.cv[index].tag +
                " no noise: give the size in CV units");
  return deviation;
}

double read_size(const Value& value, const ScenarioContext& context, int cv, const Range& range) {
  const std::optional<Quantity> size = value.quantity({"sd"}, range);
  if (!size) return 0.0;
  if (size->unit.empty()) return size->number;
  return size->number * noise_deviation(context, cv, value);
}

int find_signal(const Value& value, const std::vector<std::string>& known, std::string_view noun) {
  if (value.is_scalar()) {
    const std::string text = value.free_text().value_or("");
    for (std::size_t i = 0; i < known.size(); ++i)
      if (text == std::to_string(i + 1) &&
          std::find(known.begin(), known.end(), text) == known.end())
        return static_cast<int>(i);
  }
  return find_tag(value, known, noun);
}

std::vector<int> read_signals(const Map& map, std::string_view key,
                              const std::vector<std::string>& known, std::string_view noun) {
  std::vector<int> indices;
  const Value* value = map.find(key);
  if (value == nullptr) {
    for (std::size_t i = 0; i < known.size(); ++i) indices.push_back(static_cast<int>(i));
    return indices;
  }
  for (const Value& item : value->items())
    if (const int index = find_signal(item, known, noun); index >= 0) indices.push_back(index);
  return indices;
}

void load_noise(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario) {
  const Map map =
      item.map({"cv", "sigma_ratio", "student_t", "follows", "lag", "gain", "from", "until"});
  const std::vector<std::string> cvs = context.unit.cv_tags();
  NoiseChange change;
  if (const Value* ratio = map.find("sigma_ratio"))
    change.sigma_ratio = ratio->number(kNotNegative).value_or(1.0);
  if (const Value* freedom = map.find("student_t"))
    change.student_t = freedom->number({.low = 2.0, .high = 1000.0, .low_open = true});
  if (const Value* leader = map.find("follows")) {
    if (const int index = find_signal(*leader, cvs, "cv"); index >= 0)
      change.follows = cvs[static_cast<std::size_t>(index)];
  }
  for (const char* key : {"lag", "gain"})
    if (map.find(key) != nullptr && map.find("follows") == nullptr)
      map.find(key)->error("belongs to `follows`, the CV whose noise leads");
  if (const Value* lag = map.find("lag"))
    change.lag_samples = lag->integer({.low = 0, .high = 100000}).value_or(0);
  if (const Value* gain = map.find("gain")) change.gain = gain->number().value_or(1.0);
  read_span(map, context, change.from_s, change.until_s);
  if (map.find("sigma_ratio") == nullptr && map.find("student_t") == nullptr &&
      map.find("follows") == nullptr)
    item.error("changes nothing: give sigma_ratio, student_t or follows");
  if (map.find("cv") == nullptr && !change.follows) {
    scenario.noise.push_back(change);
    return;
  }
  for (const int cv : read_signals(map, "cv", cvs, "cv")) {
    change.cv = cvs[static_cast<std::size_t>(cv)];
    if (change.follows != change.cv) {
      scenario.noise.push_back(change);
    } else if (map.find("cv") != nullptr) {
      map.find("follows")->error("a CV's noise cannot follow itself");
    }
  }
}

void load_disturbance(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario) {
  std::vector<std::string> known = {"cv", "from", "until"};
  const KindKey* kind = nullptr;
  for (const KindKey& each : kKinds) {
    known.emplace_back(each.key);
    if (kind == nullptr && item.has_any_key({each.key})) kind = &each;
  }
  if (kind == nullptr) {
    for (const KindKey& each : kKinds)
      for (std::string& key : keys_of(each.kind)) known.push_back(std::move(key));
    static_cast<void>(item.map(known));
    item.error("give one of step, ramp, drift, periodic, sensor_noise");
    return;
  }
  known = {"cv", "from", "until", kind->key};
  for (std::string& key : keys_of(kind->kind)) known.push_back(std::move(key));
  const Map map = item.map(known, "key of a " + std::string(kind->key));
  Disturbance disturbance;
  disturbance.kind = kind->kind;
  read_span(map, context, disturbance.from_s, disturbance.until_s);
  read_shape(map, context, disturbance);
  const std::vector<std::string> cvs = context.unit.cv_tags();
  for (const int cv : read_signals(map, "cv", cvs, "cv")) {
    disturbance.cv = cvs[static_cast<std::size_t>(cv)];
    disturbance.size = read_size(*map.find(kind->key), context, cv, kind->size);
    scenario.disturbances.push_back(disturbance);
  }
}

void load_test(const Value& item, const ScenarioContext& context, ScenarioConfig& scenario) {
  const Map map = item.map({"mv", "size", "hold", "random", "from", "until"});
  TestSignal test;
  if (const Value* size = map.require("size")) test.size = size->number(kPositive).value_or(1.0);
  if (const Value* hold = map.require("hold"))
    test.hold_s = read_time(*hold, context, kPositive).value_or(1.0);
  if (const Value* random = map.find("random")) test.random = random->boolean().value_or(true);
  read_span(map, context, test.from_s, test.until_s);
  const std::vector<std::string> mvs = mv_tags(context.unit);
  for (const int mv : read_signals(map, "mv", mvs, "mv")) {
    test.mv = mvs[static_cast<std::size_t>(mv)];
    scenario.tests.push_back(test);
  }
}

void load_process_change(const Value& item, const ScenarioContext& context,
                         ScenarioConfig& scenario) {
  const Map map = item.map({"quantity", "value", "from", "until"});
  ProcessChange change;
  change.place = item.where();
  if (context.unit.simulation.process.empty())
    item.error("the unit file names no `simulation: process:` whose numbers could change");
  if (const Value* quantity = map.require("quantity"))
    change.quantity = quantity->text().value_or("");
  if (const Value* value = map.require("value")) change.value = value->number().value_or(0.0);
  read_span(map, context, change.from_s, change.until_s);
  scenario.process.push_back(change);
}

void load_scenario_setpoints(const Value& section, const ScenarioContext& context,
                             ScenarioConfig& scenario) {
  const Map map = section.map({"amplitude_ratio", "constant", "equal", "moving"});
  const std::vector<std::string> cvs = context.unit.cv_tags();
  if (const Value* ratio = map.find("amplitude_ratio"))
    scenario.setpoint_amplitude_ratio = ratio->number(kNotNegative);
  if (const Value* constant = map.find("constant"))
    scenario.constant_setpoints = constant->boolean().value_or(false);
  if (const Value* equal = map.find("equal")) {
    for (const int cv : read_signals(map, "equal", cvs, "cv"))
      scenario.equal_setpoints.push_back(cvs[static_cast<std::size_t>(cv)]);
    if (equal->items().size() < 2) equal->error("give two CVs or more");
  }
  if (map.find("moving") != nullptr) {
    scenario.moving_setpoints.emplace();
    for (const int cv : read_signals(map, "moving", cvs, "cv"))
      scenario.moving_setpoints->push_back(cvs[static_cast<std::size_t>(cv)]);
  }
}

void load_scenario_controller(const Value& section, const ScenarioContext& context,
                              ScenarioConfig& scenario) {
  const Map map = section.map(
      {"integral_action", "disturbance_feedback", "off", "mv_limits", "allow_unstable"});
  if (const Value* flag = map.find("integral_action"))
    scenario.integral_action = flag->boolean().value_or(true);
  if (const Value* part = map.find("disturbance_feedback"))
    scenario.disturbance_feedback = part->number(kShare).value_or(1.0);
  if (const Value* flag = map.find("allow_unstable"))
    scenario.allow_unstable = flag->boolean().value_or(false);
  load_list(map, "off", [&](const Value& item) {
    TimeSpan span;
    read_span(item.map({"from", "until"}), context, span.from_s, span.until_s);
    scenario.controller_off.push_back(span);
  });
  load_list(map, "mv_limits", [&](const Value& item) {
    const Map limits = item.map({"mv", "ratio", "low", "high", "max_move"});
    MvLimitChange change;
    if (const Value* ratio = limits.find("ratio"))
      change.ratio = ratio->number(kPositive).value_or(1.0);
    if (const Value* low = limits.find("low")) change.low = low->number();
    if (const Value* high = limits.find("high")) change.high = high->number();
    if (const Value* move = limits.find("max_move")) change.max_move = move->number(kPositive);
    if (change.low && change.high && *change.low >= *change.high)
      limits.find("high")->error("must be above low");
    const std::vector<std::string> mvs = mv_tags(context.unit);
    for (const int mv : read_signals(limits, "mv", mvs, "mv")) {
      change.mv = mvs[static_cast<std::size_t>(mv)];
      scenario.mv_limits.push_back(change);
    }
  });
}

}  // namespace mpm::config
