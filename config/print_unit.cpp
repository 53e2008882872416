#include <ostream>
#include <string_view>
#include <type_traits>

#include "config/choice.hpp"
#include "config/fields.hpp"
#include "config/load_unit.hpp"
#include "config/print_model.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

template <class Settings>
std::string field_text(const Field<Settings>& field, const Settings& settings) {
  const auto text = [&](auto member) {
    using Type = std::remove_cv_t<std::remove_reference_t<decltype(settings.*member)>>;
    if constexpr (std::is_enum_v<Type>)
      return name_of(settings.*member);
    else
      return yaml_text(settings.*member);
  };
  return std::visit(text, field.member);
}

/// One key per line, each with its note.
template <class Settings>
void print_fields(const std::vector<Field<Settings>>& fields, const Settings& settings,
                  std::ostream& out) {
  for (const Field<Settings>& field : fields) {
    out << "  " << field.key << ": " << field_text(field, settings);
    if (*field.notes != '\0') out << "  # " << field.notes;
    out << '\n';
  }
}

template <class Settings>
std::string inline_fields(const std::vector<Field<Settings>>& fields, const Settings& settings) {
  std::string text = "{";
  for (const Field<Settings>& field : fields)
    text +=
        (text.size() > 1 ? ", " : "") + std::string(field.key) + ": " + field_text(field, settings);
  return text + "}";
}

template <class Signal>
void print_signals(std::string_view kind, const std::vector<Signal>& signals, std::ostream& out) {
  out << "  " << kind << ':' << (signals.empty() ? " []\n" : "\n");
  for (const Signal& signal : signals) {
    out << "    - {tag: " << yaml_text(signal.tag);
    const auto print = [&out](const char* key, const std::string& text) {
      if (!text.empty()) out << ", " << key << ": " << yaml_text(text);
    };
    if constexpr (std::is_same_v<Signal, CvSignal>) {
      print("prediction", signal.prediction);
      print("setpoint", signal.setpoint);
    }
    print("unit", signal.unit);
    print("description", signal.description);
    if (signal.limits.low) out << ", low: " << yaml_text(*signal.limits.low);
    if (signal.limits.high) out << ", high: " << yaml_text(*signal.limits.high);
    out << "}\n";
  }
}

void print_calculated(const UnitConfig& config, std::ostream& out) {
  if (config.calc.empty()) return;
  out << "  calc:\n";
  for (const CalculatedSignal& signal : config.calc) {
    out << "    " << yaml_text(signal.tag) << ": ";
    if (signal.unit.empty())
      out << yaml_text(signal.expression) << '\n';
    else
      out << "{expression: " << yaml_text(signal.expression) << ", unit: " << yaml_text(signal.unit)
          << "}\n";
  }
}

template <class Settings, class Text>
void print_each(std::string_view key, const std::vector<std::string>& tags,
                const std::vector<Settings>& settings, Text text, std::ostream& out) {
  if (tags.empty()) return;
  out << "  " << key << ":\n";
  for (std::size_t i = 0; i < tags.size(); ++i)
    out << "    " << yaml_text(tags[i]) << ": " << text(settings[i]) << '\n';
}

void print_limits(const UnitConfig& config, std::ostream& out) {
  const auto print = [&out](const std::string& tag, const auto& limits, const auto& max_move) {
    std::string text;
    const auto add = [&text](const char* key, const std::optional<double>& value) {
      if (value) text += (text.empty() ? "" : ", ") + std::string(key) + ": " + yaml_text(*value);
    };
    add("low", limits.low);
    add("high", limits.high);
    add("max_move", max_move);
    out << "    " << yaml_text(tag) << ": {" << text << "}\n";
  };
  out << "  limits:\n";
  for (std::size_t i = 0; i < config.mv.size(); ++i) {
    const MvLimits& limits = config.simulation.mv_limits[i];
    print(config.mv[i].tag, limits, limits.max_move);
  }
  for (std::size_t i = 0; i < config.cv.size(); ++i)
    print(config.cv[i].tag, config.simulation.cv_limits[i], std::optional<double>());
}

void print_simulation(const UnitConfig& config, std::ostream& out) {
  const SimulationSettings& simulation = config.simulation;
  const std::vector<std::string> cvs = config.cv_tags();
  std::vector<std::string> mvs, dvs, auxiliaries;
  for (const InputSignal& mv : config.mv) mvs.push_back(mv.tag);
  for (const InputSignal& dv : config.dv) dvs.push_back(dv.tag);
  for (const InputSignal& aux : config.aux) auxiliaries.push_back(aux.tag);
  const auto number = [](double value) { return yaml_text(value); };
  const auto noise = [](const NoiseSettings& each) { return inline_fields(noise_fields(), each); };
  const auto setpoint = [](const SetpointSettings& each) {
    return inline_fields(setpoint_fields(), each);
  };
  out << "simulation:  # mpmsim only\n";
  if (!simulation.process.empty()) out << "  process: " << yaml_text(simulation.process) << '\n';
  print_fields(simulation_fields(), simulation, out);
  out << "  move_blocks: "
      << yaml_text(
             std::vector<double>(simulation.move_blocks.begin(), simulation.move_blocks.end()))
      << "  # samples\n";
  print_each("cv_weights", cvs, simulation.cv_weights, number, out);
  print_each("move_weights", mvs, simulation.move_weights, number, out);
  print_limits(config, out);
  print_each("noise", cvs, simulation.noise, noise, out);
  print_each("dv_movement", dvs, simulation.dv_movement, noise, out);
  print_each("aux_movement", auxiliaries, simulation.aux_movement, noise, out);
  print_each("setpoints", cvs, simulation.setpoints, setpoint, out);
}

void print_materiality(const UnitConfig& config, std::ostream& out) {
  const MonitorSettings& monitor = config.monitor;
  const std::string limits = inline_fields(materiality_fields(), monitor.materiality);
  out << "  materiality:";
  if (monitor.channel_materiality.empty()) {
    out << ' ' << limits << '\n';
    return;
  }
  out << '\n';
  for (const Field<MaterialitySettings>& field : materiality_fields())
    out << "    " << field.key << ": " << field_text(field, monitor.materiality) << '\n';
  out << "    channels:\n";
  for (const ChannelMateriality& channel : monitor.channel_materiality)
    out << "      - {cv: " << yaml_text(config.cv[static_cast<std::size_t>(channel.cv)].tag)
        << ", mv: " << yaml_text(config.input_tag(channel.input)) << ", "
        << inline_fields(materiality_fields(), channel.limits).substr(1) << '\n';
}

void print_identify(const UnitConfig& config, std::ostream& out) {
  if (config.identify.empty()) return;
  out << "identify:\n  channels:\n";
  for (const ChannelHint& hint : config.identify) {
    out << "    - {cv: " << yaml_text(config.cv[static_cast<std::size_t>(hint.cv)].tag)
        << ", mv: " << yaml_text(config.input_tag(hint.input));
    if (hint.no_relation) out << ", relation: none";
    if (hint.sign != 0) out << ", sign: \"" << (hint.sign > 0 ? '+' : '-') << '"';
    if (hint.dead_time_s) out << ", dead_time: " << yaml_text(*hint.dead_time_s);
    if (hint.integrating) out << ", integrating: " << (*hint.integrating ? "true" : "false");
    out << "}\n";
  }
}

}  // namespace

void print_model_section(const UnitConfig& config, std::ostream& out) { print_model(config, out); }

void print_unit(const UnitConfig& config, std::ostream& out) {
  out << "unit: " << yaml_text(config.unit) << '\n'
      << "sample_time: " << yaml_text(config.sample_time_s) << "  # s\n"
      << "signals:\n";
  print_signals("mv", config.mv, out);
  print_signals("dv", config.dv, out);
  print_signals("cv", config.cv, out);
  print_signals("aux", config.aux, out);
  if (!config.raw.empty()) print_signals("raw", config.raw, out);
  print_calculated(config, out);
  print_model(config, out);
  out << "monitor:\n";
  print_fields(monitor_fields(), config.monitor, out);
  print_materiality(config, out);
  out << "alarms:\n";
  print_fields(alarm_fields(), config.alarms, out);
  print_fields(managed_alarm_fields(), config.alarm_handling.managed, out);
  out << "  controller: "
      << inline_fields(controller_alarm_fields(), config.alarm_handling.controller) << '\n';
  out << "dds:\n";
  print_fields(bus_fields(), config.dds, out);
  out << "  peers: " << yaml_text(config.dds.peers) << '\n';
  print_simulation(config, out);
  print_identify(config, out);
}

}  // namespace mpm::config
