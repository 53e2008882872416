#include "core/identification/identify_long.hpp"

#include <algorithm>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/identify_readings.hpp"

namespace mpm {

using Eigen::Index;

namespace {

/// Of what came out: what integrates is at least so slow that the longest run does not show it
/// settle.
PlantSpeed speed_found(const Identification& found, const Recording& recording) {
  PlantSpeed speed = speed_of(found.model);
  Index longest = 0;
  for (const Run& run : runs_of(recording)) longest = std::max(longest, run.count);
  const double unsettled_s =
      kMayIntegrateShare * static_cast<double>(longest) * recording.sample_time_s;
  for (const ChannelAnswer& answer : found.channels) {
    if (answer.left_out != LeftOut::kIdentified || !answer.dynamics->integrating) continue;
    speed.slowest_s = std::max(speed.slowest_s, unsettled_s);
    if (speed.fastest_s == 0.0) speed.fastest_s = unsettled_s;
  }
  return speed;
}

}  // namespace

LongIdentification identify_long(const Recording& recording,
                                 const IdentificationSettings& settings) {
  PlantSpeed speed;
  for (Index every = rows_to_average(recording, kMostIdentified);
       every > 1 && speed.fastest_s == 0.0; every = every / kFiner) {
    const Recording few = condensed(recording, every, kScoutRows).recording;
    speed = speed_found(identify(few, settings), few);
  }
  LongIdentification result;
  result.data =
      condensed(recording, rows_to_average(recording, speed, kMostIdentified), kMostIdentified);
  result.identification = identify(result.data.recording, settings);
  identify_readings(recording, settings, result.identification);
  return result;
}

ModelSpec model_at(const Identification& identification, double sample_time_s) {
  ModelSpec model = identification.model;
  model.sample_time_s = sample_time_s;
  for (ChannelSpec& channel : model.channels)
    for (const ChannelAnswer& answer : identification.channels)
      if (answer.cv == channel.cv && answer.input == channel.input && answer.pair)
        channel.dynamics = sampled(*answer.pair, answer.dynamics->gain,
                                   answer.dynamics->dead_time_s, sample_time_s);
  return model;
}

}  // namespace mpm
