#include "sim/loop/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mpm::sim {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd origin_of(const VectorXd& origin, int size) {
  return origin.size() != 0 ? origin : VectorXd::Zero(size);
}

double amplitude_ratio(const config::ScenarioConfig& scenario) {
  return scenario.constant_setpoints ? 0.0 : scenario.setpoint_amplitude_ratio.value_or(1.0);
}

const std::vector<config::SetpointSettings> setpoint_settings(const config::UnitConfig& unit) {
  std::vector<config::SetpointSettings> settings = unit.simulation.setpoints;
  settings.resize(unit.cv.size());
  return settings;
}

}  // namespace

double feedback_share(const config::ScenarioConfig& scenario) {
  if (!scenario.integral_action && scenario.disturbance_feedback == 1.0) return 0.0;
  return scenario.disturbance_feedback;
}

ClosedLoop::ClosedLoop(const LoopSetup& setup)
    : sample_time_s_(setup.unit.sample_time_s),
      start_time_ns_(setup.start_time_ns),
      plant_(setup.unit.model, setup.changes),
      controller_(setup.controller_model, static_cast<int>(setup.unit.mv.size()),
                  setup.unit.simulation, feedback_share(setup.scenario)),
      setpoints_(setpoint_settings(setup.unit),
                 origin_of(setup.unit.model.output_origin, setup.unit.model.cv_count),
                 amplitude_ratio(setup.scenario), setup.seed),
      frame_(setup.unit.counts()) {
  const config::UnitConfig& unit = setup.unit;
  if (setup.controller_model.input_count != unit.model.input_count ||
      setup.controller_model.cv_count != unit.model.cv_count)
    throw std::invalid_argument("the controller's model has other signals than the plant");
  const VectorXd input_origin = origin_of(unit.model.input_origin, unit.model.input_count);
  disturbance_origin_ = input_origin.tail(static_cast<Index>(unit.dv.size()));
  input_ = input_origin;
  true_output_ = plant_.output();
  noise_ratio_ = VectorXd::Ones(unit.model.cv_count);

  std::vector<config::NoiseSettings> noise = unit.simulation.noise;
  std::vector<config::NoiseSettings> movement = unit.simulation.dv_movement;
  noise.resize(unit.cv.size());
  movement.resize(unit.dv.size());
  for (std::size_t i = 0; i < noise.size(); ++i)
    noise_.emplace_back(noise[i], RandomStream(setup.seed, StreamPurpose::kNoise, i));
  for (std::size_t i = 0; i < movement.size(); ++i)
    movement_.emplace_back(movement[i], RandomStream(setup.seed, StreamPurpose::kDisturbance, i));

  const std::vector<std::string> cvs = unit.cv_tags();
  for (const config::NoiseChange& change : setup.scenario.noise)
    for (std::size_t cv = 0; cv < cvs.size(); ++cv)
      if (!change.cv || *change.cv == cvs[cv])
        noise_steps_.push_back(
            {static_cast<int>(cv), change.sigma_ratio,
             static_cast<std::int64_t>(std::ceil(change.from_s / sample_time_s_ - 1e-9))});

  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                SignalKind::kPrediction, SignalKind::kSetpoint})
    std::fill(frame_[kind].quality.begin(), frame_[kind].quality.end(), Quality::kGood);
}

const Frame& ClosedLoop::step() {
  begin_noise_changes();
  SignalBlock& disturbances = frame_[SignalKind::kDv];
  for (std::size_t i = 0; i < movement_.size(); ++i)
    disturbances.values(static_cast<Index>(i)) =
        disturbance_origin_(static_cast<Index>(i)) + movement_[i].next();
  SignalBlock& measured = frame_[SignalKind::kCv];
  true_output_ = plant_.output();
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    const auto cv = static_cast<Index>(i);
    measured.values(cv) = true_output_(cv) + noise_[i].next(noise_ratio_(cv));
  }
  SignalBlock& setpoints = frame_[SignalKind::kSetpoint];
  setpoints.values = setpoints_.next();
  frame_[SignalKind::kPrediction].values = controller_.prediction();
  SignalBlock& moved = frame_[SignalKind::kMv];
  moved.values = controller_.control(measured.values, setpoints.values, disturbances.values);

  input_.head(moved.values.size()) = moved.values;
  input_.tail(disturbances.values.size()) = disturbances.values;
  plant_.advance(input_);
  finite_ = finite_ && measured.values.allFinite() && moved.values.allFinite();

  frame_.interval = interval_;
  frame_.source_time_ns =
      start_time_ns_ + std::llround(static_cast<double>(interval_) * sample_time_s_ * 1e9);
  ++interval_;
  return frame_;
}

void ClosedLoop::begin_noise_changes() {
  for (const NoiseStep& change : noise_steps_)
    if (change.first_interval == interval_) noise_ratio_(change.cv) *= change.sigma_ratio;
}

}  // namespace mpm::sim
