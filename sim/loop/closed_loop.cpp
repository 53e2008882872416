#include "sim/loop/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/plant/hidden_plant.hpp"
#include "sim/plant/recovery_boiler/boiler_process.hpp"

namespace mpm::sim {
namespace {

const char* const kRecoveryBoiler = "recovery_boiler";

using Eigen::Index;
using Eigen::VectorXd;

VectorXd origin_of(const VectorXd& origin, int size) {
  return origin.size() != 0 ? origin : VectorXd::Zero(size);
}

bool holds(const std::vector<std::string>& tags, const std::string& tag) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

std::vector<SetpointSource> setpoint_sources(const config::UnitConfig& unit,
                                             const config::ScenarioConfig& scenario) {
  std::vector<config::SetpointSettings> settings = unit.simulation.setpoints;
  settings.resize(unit.cv.size());
  const std::vector<std::string> tags = unit.cv_tags();
  const double ratio =
      scenario.constant_setpoints ? 0.0 : scenario.setpoint_amplitude_ratio.value_or(1.0);
  std::vector<SetpointSource> sources;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const bool moves = !scenario.moving_setpoints || holds(*scenario.moving_setpoints, tags[i]);
    settings[i].amplitude *= moves ? ratio : 0.0;
    sources.push_back({settings[i], i});
    if (holds(scenario.equal_setpoints, tags[i]))
      sources.back().leader = static_cast<std::size_t>(
          std::find(tags.begin(), tags.end(), scenario.equal_setpoints.front()) - tags.begin());
  }
  return sources;
}

void scale_about(std::optional<double>& limit, double origin, double ratio) {
  if (limit) limit = origin + ratio * (*limit - origin);
}

}  // namespace

config::SimulationSettings limited_settings(const config::UnitConfig& unit,
                                            const config::ScenarioConfig& scenario) {
  config::SimulationSettings settings = unit.simulation;
  settings.mv_limits.resize(unit.mv.size());
  const VectorXd origin = origin_of(unit.model.input_origin, unit.model.input_count);
  for (const config::MvLimitChange& change : scenario.mv_limits) {
    for (std::size_t mv = 0; mv < unit.mv.size(); ++mv) {
      if (unit.mv[mv].tag != change.mv) continue;
      config::MvLimits& limits = settings.mv_limits[mv];
      scale_about(limits.low, origin(static_cast<Index>(mv)), change.ratio);
      scale_about(limits.high, origin(static_cast<Index>(mv)), change.ratio);
      if (change.low) limits.low = change.low;
      if (change.high) limits.high = change.high;
      if (change.max_move) limits.max_move = change.max_move;
      if (limits.low && limits.high && *limits.low >= *limits.high)
        throw std::invalid_argument("mv_limits: the low limit of " + change.mv +
                                    " is not below its high limit");
    }
  }
  return settings;
}

double feedback_share(const config::ScenarioConfig& scenario) {
  if (!scenario.integral_action && scenario.disturbance_feedback == 1.0) return 0.0;
  return scenario.disturbance_feedback;
}

std::unique_ptr<Process> make_process(const LoopSetup& setup) {
  const std::string& name = setup.unit.simulation.process;
  if (name.empty()) {
    const config::HiddenPlant& hidden = setup.scenario.plant;
    return std::make_unique<Plant>(plant_model(setup.unit, hidden), setup.changes);
  }
  if (name != kRecoveryBoiler)
    throw std::invalid_argument("there is no process '" + name + "'; known: " + kRecoveryBoiler);
  if (!setup.changes.empty() || !setup.scenario.plant.empty())
    throw std::invalid_argument("`changes`, `draw` and `plant` alter a model; what the process '" +
                                name + "' hides is under `process`");
  return std::make_unique<boiler::BoilerProcess>(setup.unit, setup.scenario.process, setup.seed);
}

ClosedLoop::ClosedLoop(const LoopSetup& setup)
    : sample_time_s_(setup.unit.sample_time_s),
      start_time_ns_(setup.start_time_ns),
      plant_(make_process(setup)),
      controller_(setup.controller_model, static_cast<int>(setup.unit.mv.size()),
                  limited_settings(setup.unit, setup.scenario), feedback_share(setup.scenario)),
      setpoints_(setpoint_sources(setup.unit, setup.scenario),
                 origin_of(setup.unit.model.output_origin, setup.unit.model.cv_count), setup.seed),
      output_disturbance_(setup.unit, setup.scenario, setup.seed),
      tests_(setup.scenario.tests, setup.unit.input_tags(),
             origin_of(setup.unit.model.input_origin, setup.unit.model.input_count)
                 .head(static_cast<Index>(setup.unit.mv.size())),
             setup.unit.sample_time_s, setup.seed),
      frame_(setup.unit.counts()) {
  const config::UnitConfig& unit = setup.unit;
  if (setup.controller_model.input_count != unit.model.input_count ||
      setup.controller_model.cv_count != unit.model.cv_count)
    throw std::invalid_argument("the controller's model has other signals than the plant");
  const VectorXd input_origin = origin_of(unit.model.input_origin, unit.model.input_count);
  disturbance_origin_ = input_origin.tail(static_cast<Index>(unit.dv.size()));
  const Index aux_count =
      plant_->input_count() > unit.model.input_count ? static_cast<Index>(unit.aux.size()) : 0;
  input_ = VectorXd::Zero(input_origin.size() + aux_count);
  input_.head(input_origin.size()) = input_origin;
  const double start_s = 1e-9 * static_cast<double>(start_time_ns_);
  plant_->set_time_s(start_s);
  controller_.set_time_s(start_s);
  true_output_ = plant_->output();

  std::vector<config::NoiseSettings> movement = unit.simulation.dv_movement;
  movement.resize(unit.dv.size());
  for (std::size_t i = 0; i < movement.size(); ++i)
    movement_.emplace_back(movement[i], RandomStream(setup.seed, StreamPurpose::kDisturbance, i));
  std::vector<config::NoiseSettings> aux_movement = unit.simulation.aux_movement;
  aux_movement.resize(unit.aux.size());
  for (std::size_t i = 0; i < aux_movement.size(); ++i)
    aux_movement_.emplace_back(aux_movement[i], RandomStream(setup.seed, StreamPurpose::kAux, i));
  for (const config::TimeSpan& off : setup.scenario.controller_off)
    controller_off_.emplace_back(off.from_s, off.until_s, sample_time_s_);

  for (const SignalKind kind : {SignalKind::kMv, SignalKind::kDv, SignalKind::kCv,
                                SignalKind::kPrediction, SignalKind::kSetpoint, SignalKind::kAux})
    std::fill(frame_[kind].quality.begin(), frame_[kind].quality.end(), Quality::kGood);
}

const Frame& ClosedLoop::step() {
  SignalBlock& disturbances = frame_[SignalKind::kDv];
  for (std::size_t i = 0; i < movement_.size(); ++i)
    disturbances.values(static_cast<Index>(i)) =
        disturbance_origin_(static_cast<Index>(i)) + movement_[i].next();
  SignalBlock& aux = frame_[SignalKind::kAux];
  for (std::size_t i = 0; i < aux_movement_.size(); ++i)
    aux.values(static_cast<Index>(i)) = aux_movement_[i].next();
  aux.values.head(plant_->measured_aux().size()) += plant_->measured_aux();
  SignalBlock& measured = frame_[SignalKind::kCv];
  true_output_ = plant_->output();
  measured.values = true_output_ + output_disturbance_.next();
  SignalBlock& setpoints = frame_[SignalKind::kSetpoint];
  setpoints.values = setpoints_.next();
  frame_[SignalKind::kPrediction].values = controller_.prediction();
  SignalBlock& moved = frame_[SignalKind::kMv];
  const bool off = std::any_of(controller_off_.begin(), controller_off_.end(),
                               [this](const IntervalRange& r) { return r.contains(interval_); });
  if (tests_.advance(interval_))
    moved.values = controller_.follow(tests_.values(), disturbances.values);
  else if (off)
    moved.values = controller_.hold(disturbances.values);
  else
    moved.values = controller_.control(measured.values, setpoints.values, disturbances.values);

  input_.head(moved.values.size()) = moved.values;
  input_.segment(moved.values.size(), disturbances.values.size()) = disturbances.values;
  const Index model_inputs = moved.values.size() + disturbances.values.size();
  if (input_.size() > model_inputs) input_.tail(aux.values.size()) = aux.values;
  plant_->advance(input_);
  finite_ = finite_ && measured.values.allFinite() && moved.values.allFinite();

  frame_.interval = interval_;
  frame_.source_time_ns =
      start_time_ns_ + std::llround(static_cast<double>(interval_) * sample_time_s_ * 1e9);
  ++interval_;
  return frame_;
}

}  // namespace mpm::sim
