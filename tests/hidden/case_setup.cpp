#include "tests/hidden/case_setup.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "config/load_unit.hpp"
#include "sim/signals/coloured_noise.hpp"
#include "sim/signals/random_stream.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using sim::RandomStream;
using sim::StreamPurpose;

constexpr double kBackgroundGain = 0.02, kBackgroundLag = 0.03;

double cut_normal(RandomStream& stream) {
  for (;;)
    if (const double value = stream.normal(); std::abs(value) <= 2.0) return value;
}

bool is_linear_error(const TrueEffect& effect) {
  for (const char* name : {"gain_ratio", "time_constant_ratio", "dead_time_error"})
    if (effect.parameters.count(name) > 0) return true;
  return false;
}

bool is_about(const TrueEffect& effect, const TrueChannel& channel) {
  return (effect.place.cv < 0 || effect.place.cv == channel.cv) &&
         (effect.place.input < 0 || effect.place.input == channel.input);
}

std::vector<double> sorted(const Eigen::VectorXd& values) {
  std::vector<double> result(values.begin(), values.end());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

std::string plant_path(const std::string& plant) {
  return std::string(MPM_SOURCE_DIR) + "/config/plants/" + plant + ".yaml";
}

config::UnitConfig load_plant(const std::string& plant) {
  const std::string path = plant_path(plant);
  config::LoadResult loaded = config::load_unit(path);
  if (!loaded.ok()) throw std::runtime_error("cannot read " + path);
  config::SimulationSettings& simulation = loaded.config.simulation;
  simulation.noise.resize(loaded.config.cv.size());
  simulation.dv_movement.resize(loaded.config.dv.size());
  simulation.setpoints.resize(loaded.config.cv.size());
  return loaded.config;
}

std::vector<CvNoise> draw_noise_model(const config::UnitConfig& unit, bool hard,
                                      std::uint64_t seed) {
  std::vector<CvNoise> result;
  RandomStream stream(seed, StreamPurpose::kSensorNoise, 0);
  const bool tails = stream.uniform() < 1.0 / 3;
  const double freedom = 4.0 + stream.uniform();
  for (const config::NoiseSettings& settings : unit.simulation.noise) {
    CvNoise noise;
    noise.sigma = settings.sigma;
    noise.pole = settings.pole;
    if (hard) {
      const double level = noise.deviation() * std::exp2(2.0 * stream.uniform() - 1.0);
      noise.pole = 0.8 + 0.17 * stream.uniform();
      noise.moving = -0.5 + stream.uniform();
      noise.freedom = tails ? freedom : 0.0;
      noise.sigma = 1.0;
      noise.sigma = level / noise.deviation();
    }
    result.push_back(noise);
  }
  return result;
}

MatrixXd draw_dvs(const config::UnitConfig& unit, const TruePlantSpec& plant, int samples,
                  std::uint64_t seed) {
  MatrixXd dvs(samples, static_cast<Index>(unit.dv.size()));
  for (std::size_t i = 0; i < unit.dv.size(); ++i) {
    sim::ColouredNoise movement(unit.simulation.dv_movement[i],
                                RandomStream(seed, StreamPurpose::kDisturbance, i));
    const double origin = plant.input_origin(static_cast<Index>(unit.mv.size() + i));
    for (Index k = 0; k < samples; ++k) dvs(k, static_cast<Index>(i)) = origin + movement.next();
  }
  return dvs;
}

void add_background(TruePlantSpec& plant, const std::vector<TrueEffect>& hidden, std::uint64_t seed,
                    std::uint64_t attempt) {
  for (TrueChannel& channel : plant.channels) {
    if (channel.input >= plant.input_count) continue;  // an aux signal's: in no model
    // By its place, so that a channel split in two by an onset has one error.
    const auto place = static_cast<std::uint64_t>(channel.cv * plant.input_count + channel.input);
    RandomStream stream(seed, StreamPurpose::kHiddenChange, 1000000 + 1000 * attempt + place);
    const double gain = 1.0 + kBackgroundGain * cut_normal(stream);
    const double lag = 1.0 + kBackgroundLag * cut_normal(stream);
    if (std::any_of(hidden.begin(), hidden.end(), [&](const TrueEffect& effect) {
          return is_linear_error(effect) && is_about(effect, channel);
        }))
      continue;
    channel.gain *= gain;
    channel.time_constant *= lag;
  }
}

Healthy summarise_healthy(const LoopRecord& record, const TruePlantSpec& plant, int mv_count) {
  Healthy healthy;
  for (Index mv = 0; mv < mv_count; ++mv) {
    const std::vector<double> values = sorted(record.inputs.col(mv));
    const auto end = static_cast<std::size_t>(0.02 * static_cast<double>(values.size()));
    healthy.mv_low.push_back(values[end] - plant.input_origin(mv));
    healthy.mv_high.push_back(values[values.size() - 1 - end] - plant.input_origin(mv));
  }
  for (Index cv = 0; cv < record.cvs.cols(); ++cv)
    healthy.cv_sorted.push_back(sorted(record.cvs.col(cv)));
  return healthy;
}

}  // namespace mpm::hidden
