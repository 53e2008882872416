#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "config/load_sections.hpp"

/// Readers of what a model is made of, for unit files and for what a scenario hides in a plant.
/// Private to this room.
namespace mpm::config {

/// What the parts are read against.
struct ModelSignals {
  std::vector<std::string> inputs, cvs;
  Eigen::VectorXd input_origin, output_origin;
  double sample_time_s = 1.0;
  std::string input_noun = "mv or dv";  ///< what an input is called in messages
};
/// MVs, then DVs, and the operating point read so far.
[[nodiscard]] ModelSignals signals_of(const UnitConfig& unit);

/// `{polynomial: [..]}` and the like, of an input of `inputs`; nothing (reported) where it is none.
[[nodiscard]] std::optional<InputBlock> read_input_block(const Value& value,
                                                         const std::vector<std::string>& inputs,
                                                         int input);
[[nodiscard]] std::optional<OutputBlock> read_output_block(const Value& value);
/// Blocks by tag.
void read_input_blocks(const Value& section, const std::vector<std::string>& tags,
                       std::vector<std::optional<InputBlock>>& blocks);
void read_output_blocks(const Value& section, const std::vector<std::string>& tags,
                        std::vector<std::optional<OutputBlock>>& blocks);

/// A list of channels, at most one per CV and input.
[[nodiscard]] std::vector<ChannelSpec> read_channels(const Value& list,
                                                     const ModelSignals& signals);
/// The value of `tanks:` for one channel; `cv` and `input` may be -1 where they are not known.
[[nodiscard]] TankChain read_tanks(const Value& value, const ModelSignals& signals, int cv,
                                   int input);
/// A list of terms, at most one per channel of `channels`.
[[nodiscard]] std::vector<StateTerm> read_state_terms(const Value& list,
                                                      const ModelSignals& signals,
                                                      const std::vector<ChannelSpec>& channels);
[[nodiscard]] std::vector<DisturbanceTerm> read_disturbances(const Value& list,
                                                             const ModelSignals& signals);

/// Seconds, or ISO 8601 with a zone, on the clock of the data; nothing (reported) where neither.
[[nodiscard]] std::optional<double> read_clock(const Value& value);

/// Indices of the CV and of the input (`mv` or `dv`) that an entry names, -1 where it names none
/// (reported).
struct ChannelPlace {
  int cv = -1;
  int input = -1;

  [[nodiscard]] bool known() const { return cv >= 0 && input >= 0; }
};
[[nodiscard]] ChannelPlace read_place(const Map& map, const ModelSignals& signals);

}  // namespace mpm::config
