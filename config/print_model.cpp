#include "config/print_model.hpp"

#include <cmath>
#include <ostream>
#include <string_view>
#include <type_traits>

#include "config/choice.hpp"
#include "config/yaml_text.hpp"

namespace mpm::config {
namespace {

std::string dynamics_text(const TransferFunction& tf) {
  return "gain: " + yaml_text(tf.gain) + ", time_constants: " + yaml_text(tf.time_constants_s) +
         ", lead: " + yaml_text(tf.lead_s) + ", dead_time: " + yaml_text(tf.dead_time_s) +
         ", integrating: " + yaml_text(tf.integrating);
}

std::string dynamics_text(const DiscreteFilter& filter) {
  return "numerator: " + yaml_text(filter.numerator) +
         ", denominator: " + yaml_text(filter.denominator) +
         ", delay_samples: " + yaml_text(filter.delay_samples);
}

std::string dynamics_text(const StepResponse& step) {
  return "step_response: " + yaml_text(step.values);
}

std::string dynamics_text(const TankChain& tanks) {
  const std::string overflow =
      tanks.overflow.empty() ? "" : ", overflow: " + yaml_text(tanks.overflow);
  return "tanks: {time_constants: " + yaml_text(tanks.time_constants_s) +
         ", empty_input: " + yaml_text(tanks.empty_input) +
         ", empty_output: " + yaml_text(tanks.empty_output) + overflow +
         ", spill: " + yaml_text(tanks.spill) + ", dead_time: " + yaml_text(tanks.dead_time_s) +
         "}";
}

std::string block_text(const Polynomial& block) {
  return "{polynomial: " + yaml_text(block.coefficients) + "}";
}
std::string block_text(const Saturation& block) {
  return "{saturation: " + yaml_text(std::vector<double>{block.low, block.high}) + "}";
}
std::string block_text(const Deadband& block) {
  return "{deadband: " + yaml_text(block.width) + "}";
}
std::string block_text(const Stiction& block) {
  return "{stiction: {band: " + yaml_text(block.band) + ", jump: " + yaml_text(block.jump) +
         (block.slips_once ? ", slips_once: true}}" : "}}");
}
/// A number alone where it is always in force.
std::string since(const char* key, double value, double onset_s) {
  if (!std::isfinite(onset_s)) return yaml_text(value);
  return std::string("{") + key + ": " + yaml_text(value) + ", onset: " + yaml_text(onset_s) + "}";
}
std::string block_text(const Stuck& block) {
  return "{stuck: " + since("value", block.value, block.onset_s) + "}";
}
std::string block_text(const InputOffset& block) {
  return "{offset: " + since("size", block.size, block.onset_s) + "}";
}
std::string block_text(const TwoSided& block) {
  return "{two_sided: {above: " + yaml_text(block.above) + ", below: " + yaml_text(block.below) +
         (std::isfinite(block.at) ? ", at: " + yaml_text(block.at) : "") + "}}";
}
std::string block_text(const Product& block, const std::vector<std::string>& inputs) {
  return "{product: {of: " + yaml_text(inputs[static_cast<std::size_t>(block.of)]) +
         ", per_unit: " + yaml_text(block.per_unit) +
         (block.linear != 1.0 ? ", linear: " + yaml_text(block.linear) : "") + "}}";
}
std::string block_text(const Offset& block) { return "{offset: " + yaml_text(block.bias) + "}"; }
std::string block_text(const Scale& block) { return "{scale: " + yaml_text(block.factor) + "}"; }

std::string term_text(const RestoringForce& force) {
  return "restoring_force: {quadratic: " + yaml_text(force.quadratic) +
         ", cubic: " + yaml_text(force.cubic) + "}";
}
std::string term_text(const SquareRootOutflow& outflow) {
  return "square_root_outflow: {empty_output: " + yaml_text(outflow.empty_output) + "}";
}
std::string term_text(const CoulombFriction& friction) {
  return "coulomb_friction: {force: " + yaml_text(friction.force) +
         ", speed: " + yaml_text(friction.speed) + "}";
}

/// The keys that its shape has.
std::string disturbance_text(const DisturbanceTerm& term) {
  std::string text = "shape: " + name_of(term.shape) + ", onset: " + yaml_text(term.onset_s) +
                     ", size: " + yaml_text(term.size);
  if (term.shape == DisturbanceShape::kPeriodic)
    return text + ", period: " + yaml_text(term.period_s) +
           ", wave: " + (term.square ? "square" : "sine");
  if (term.shape == DisturbanceShape::kStep)
    text += ", time_constant: " + yaml_text(term.time_constant_s);
  if (std::isfinite(term.decay_s)) text += ", decay: " + yaml_text(term.decay_s);
  if (std::isfinite(term.until_s)) text += ", until: " + yaml_text(term.until_s);
  return text;
}

/// `inputs`: the tags of all.
template <class Block>
std::string text_of(const Block& block, const std::vector<std::string>& inputs) {
  return std::visit(
      [&inputs](const auto& kind) {
        if constexpr (std::is_same_v<decltype(kind), const Product&>)
          return block_text(kind, inputs);
        else
          return block_text(kind);
      },
      block);
}

template <class Block>
void print_blocks(std::string_view key, const std::vector<std::optional<Block>>& blocks,
                  const std::vector<std::string>& tags, const std::vector<std::string>& inputs,
                  std::ostream& out) {
  bool first = true;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!blocks[i]) continue;
    if (first) out << "  " << key << ":\n";
    first = false;
    out << "    " << yaml_text(tags[i]) << ": " << text_of(*blocks[i], inputs) << '\n';
  }
}

std::string origin_text(const UnitConfig& config) {
  std::string text = "{";
  const auto add = [&text](const std::vector<std::string>& tags, const Eigen::VectorXd& values) {
    for (std::size_t i = 0; i < tags.size(); ++i)
      text += (text.size() > 1 ? ", " : "") + yaml_text(tags[i]) + ": " +
              yaml_text(values(static_cast<Eigen::Index>(i)));
  };
  add(config.input_tags(), config.model.input_origin);
  add(config.cv_tags(), config.model.output_origin);
  return text + "}";
}

void print_channels(const UnitConfig& config, std::ostream& out) {
  const std::vector<ChannelSpec>& channels = config.model.channels;
  const std::vector<std::string> cvs = config.cv_tags();
  out << "  channels:" << (channels.empty() ? "\n" : "  # times in s\n");
  for (const ChannelSpec& channel : channels) {
    out << "    - {cv: " << yaml_text(cvs[static_cast<std::size_t>(channel.cv)])
        << ", mv: " << yaml_text(config.input_tag(channel.input)) << ", "
        << std::visit([](const auto& dynamics) { return dynamics_text(dynamics); },
                      channel.dynamics);
    if (channel.input_block)
      out << ", input: " << text_of(*channel.input_block, config.input_tags());
    out << "}\n";
  }
}

void print_terms(const UnitConfig& config, std::ostream& out) {
  const ModelSpec& model = config.model;
  const std::vector<std::string> cvs = config.cv_tags();
  if (!model.state_terms.empty()) out << "  state:\n";
  for (const StateTerm& term : model.state_terms)
    out << "    - {cv: " << yaml_text(cvs[static_cast<std::size_t>(term.cv)])
        << ", mv: " << yaml_text(config.input_tag(term.input)) << ", "
        << std::visit([](const auto& block) { return term_text(block); }, term.block) << "}\n";
  if (!model.disturbances.empty()) out << "  disturbances:  # s on the clock of the data\n";
  for (const DisturbanceTerm& term : model.disturbances)
    out << "    - {cv: " << yaml_text(cvs[static_cast<std::size_t>(term.cv)]) << ", "
        << disturbance_text(term) << "}\n";
}

}  // namespace

void print_model(const UnitConfig& config, std::ostream& out) {
  const ModelSpec& model = config.model;
  out << "model:\n";
  if (model.state_space) {
    const StateSpaceSpec& system = *model.state_space;
    out << "  state_space:\n    A: " << yaml_text(system.a) << "\n    B: " << yaml_text(system.b)
        << "\n    C: " << yaml_text(system.c) << "\n    D: " << yaml_text(system.d) << '\n';
    if (system.x0.size() > 0)
      out << "    x0: "
          << yaml_text(std::vector<double>(system.x0.data(), system.x0.data() + system.x0.size()))
          << '\n';
  } else {
    print_channels(config, out);
  }
  const std::vector<std::string> inputs = config.input_tags();
  print_blocks("input", model.input_blocks, inputs, inputs, out);
  print_blocks("output", model.output_blocks, config.cv_tags(), inputs, out);
  print_terms(config, out);
  out << "  operating_point: " << origin_text(config) << '\n';
}

}  // namespace mpm::config
