#pragma once

#include <string>
#include <vector>

#include "core/identify/causes/cause.hpp"

/// What the causes share that put a channel's gain, time constants and dead time right.
namespace mpm {

/// The numbers, each with its prior. `start` and `removable` in samples: how much dead time there
/// is to take away.
[[nodiscard]] Coordinate gain_ratio_coordinate();
[[nodiscard]] Coordinate time_constant_coordinate(double start_log_ratio);
[[nodiscard]] Coordinate dead_time_coordinate(double start_samples, double removable_samples);

/// The same three where nothing is known of the channel beforehand: as reports estimate them.
[[nodiscard]] std::vector<Coordinate> open_channel_coordinates(double removable_samples);

/// Edits all channels at the effect's place by those of its numbers that are errors of a channel.
void edit_channels(const Effect& effect, const Surroundings& surroundings, ModelSpec& model);

/// Dead time (samples) that can be taken from a channel.
[[nodiscard]] double removable_samples(const ChannelSpec& channel, double sample_time_s);
/// Tanks have their gain from their levels.
[[nodiscard]] bool has_own_gain(const ChannelSpec& channel);
[[nodiscard]] Place place_of(const ChannelSpec& channel);

/// Where an error may begin, and what looking there costs beside one that was there throughout.
struct ErrorOnset {
  Eigen::Index row = 0;
  double cost = 0.0;
};
/// From the start, and inside the data: where a change was seen, if one was, and at `elsewhere`,
/// moments all over them.
[[nodiscard]] std::vector<ErrorOnset> error_onsets(const Recording& recording,
                                                   bool elsewhere = true);

/// How many of a channel's errors in the effect are beyond what a model may be wrong by.
[[nodiscard]] int material_errors(const Effect& effect, const Tolerances& materiality);

/// What the effect, an error of one channel, does to the channel's step response, as a share of it:
/// by root mean squares, until the given one settles (the ramp of one that never does, for a few
/// lags); 0 where the model has no such channel.
[[nodiscard]] double share_of_step(const Effect& effect, const Surroundings& surroundings,
                                   const ModelSpec& model);

/// One error of a channel by itself: gain, time constant or dead time.
class SingleChannelError : public Cause {
 public:
  using Cause::Cause;
  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override;
  [[nodiscard]] double rarity() const override;
  [[nodiscard]] std::optional<bool> matters(const Effect& mine,
                                            const Tolerances& materiality) const override;
  [[nodiscard]] const Cause* together_with_others() const override;
};

/// Sentences on each error, empty where the finding does not have it.
[[nodiscard]] std::string gain_sentence(const Finding& finding, const SignalNames& names);
[[nodiscard]] std::string time_constant_sentence(const Finding& finding, const SignalNames& names);
[[nodiscard]] std::string dead_time_sentence(const Finding& finding, const SignalNames& names);

}  // namespace mpm
