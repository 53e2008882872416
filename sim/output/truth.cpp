#include "sim/output/truth.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/mpc/linear_gain.hpp"
#include "sim/output/model_json.hpp"
#include "sim/plant/hidden_plant.hpp"
#include "sim/scenario/stability.hpp"

namespace mpm::sim {
namespace {

using Json = nlohmann::ordered_json;

template <class Type>
Json or_null(const std::optional<Type>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// An end that never comes is null.
Json end_of(double until_s) { return std::isfinite(until_s) ? Json(until_s) : Json(nullptr); }

const char* name_of(config::DisturbanceKind kind) {
  switch (kind) {
    case config::DisturbanceKind::kStep:
      return "step";
    case config::DisturbanceKind::kRamp:
      return "ramp";
    case config::DisturbanceKind::kDrift:
      return "drift";
    case config::DisturbanceKind::kPeriodic:
      return "periodic";
    case config::DisturbanceKind::kSensorNoise:
      return "sensor_noise";
  }
  return "";
}

Json disturbance_json(const config::Disturbance& disturbance) {
  Json json = {{"cv", disturbance.cv},
               {"kind", name_of(disturbance.kind)},
               {"size", disturbance.size},
               {"from", disturbance.from_s},
               {"until", end_of(disturbance.until_s)}};
  switch (disturbance.kind) {
    case config::DisturbanceKind::kStep:
      json["time_constant"] = disturbance.time_constant_s;
      break;
    case config::DisturbanceKind::kRamp:
      json["duration"] = disturbance.duration_s;
      break;
    case config::DisturbanceKind::kDrift:
      json["pole"] = disturbance.pole;
      break;
    case config::DisturbanceKind::kPeriodic:
      json["period"] = disturbance.period_s;
      json["phase"] = disturbance.phase_degrees;
      break;
    case config::DisturbanceKind::kSensorNoise:
      break;
  }
  return json;
}

Json noise_json(const config::NoiseChange& change) {
  Json json = {{"cv", or_null(change.cv)},
               {"sigma_ratio", change.sigma_ratio},
               {"from", change.from_s},
               {"until", end_of(change.until_s)}};
  if (change.student_t) json["student_t"] = *change.student_t;
  if (change.follows) {
    json["follows"] = *change.follows;
    json["lag"] = change.lag_samples;
    json["gain"] = change.gain;
  }
  return json;
}

Json setpoints_json(const config::ScenarioConfig& scenario) {
  return {{"amplitude_ratio",
           scenario.constant_setpoints ? 0.0 : scenario.setpoint_amplitude_ratio.value_or(1.0)},
          {"equal", scenario.equal_setpoints},
          {"moving", or_null(scenario.moving_setpoints)}};
}

Json bad_data_json(const LoopSetup& setup, const BadDataFilter* filter) {
  Json list = Json::array();
  for (std::size_t i = 0; i < setup.scenario.bad_data.size(); ++i) {
    const config::BadData& bad = setup.scenario.bad_data[i];
    Json json = {{"kind", name_of(bad.kind)}, {"from", bad.from_s}, {"until", end_of(bad.until_s)}};
    if (!bad.tags.empty()) json["tags"] = bad.tags;
    if (bad.kind != config::BadDataKind::kClockSteps) json["share"] = bad.share;
    if (bad.run_samples > 0) json["run"] = bad.run_samples;
    if (!bad.sizes.empty()) json["sizes"] = bad.sizes;
    if (!bad.steps_s.empty()) json["steps"] = bad.steps_s;
    if (filter != nullptr) {
      const BadDataFilter::Details& details = filter->details()[i];
      if (bad.kind == config::BadDataKind::kClipping) {
        json["low"] = Json::array();
        json["high"] = Json::array();
        for (const double low : details.low) json["low"].push_back(end_of(low));
        for (const double high : details.high) json["high"].push_back(end_of(high));
      }
      if (!bad.steps_s.empty()) json["step_times"] = details.step_times_s;
      json["touched"] = filter->counts()[i].samples;
      json["possible"] = filter->counts()[i].possible;
    }
    list.push_back(std::move(json));
  }
  return list;
}

Json mv_limits_json(const LoopSetup& setup) {
  Json json = Json::object();
  if (setup.scenario.mv_limits.empty()) return json;
  const config::SimulationSettings settings = limited_settings(setup.unit, setup.scenario);
  for (std::size_t mv = 0; mv < setup.unit.mv.size(); ++mv)
    json[setup.unit.mv[mv].tag] = {{"low", or_null(settings.mv_limits[mv].low)},
                                   {"high", or_null(settings.mv_limits[mv].high)},
                                   {"max_move", or_null(settings.mv_limits[mv].max_move)}};
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string truth_json(const LoopSetup& setup, const std::string& controller_file,
                       const BadDataFilter* filter) {
  const config::UnitConfig& unit = setup.unit;
  const int mvs = static_cast<int>(unit.mv.size());
  Json truth;
  truth["unit"] = unit.unit;
  truth["scenario"] = setup.scenario.name;
  truth["description"] = setup.scenario.description;
  truth["seed"] = setup.seed;
  truth["sample_time"] = unit.sample_time_s;
  truth["controller_model"] = controller_file.empty() ? Json(nullptr) : Json(controller_file);
  truth["disturbance_feedback"] = feedback_share(setup.scenario);
  truth["changes"] = Json::array();
  for (const ChannelChange& change : setup.changes)
    truth["changes"].push_back({{"cv", unit.cv[static_cast<std::size_t>(change.cv)].tag},
                                {"mv", unit.input_tag(change.input)},
                                {"gain_ratio", change.gain_ratio},
                                {"time_constant_ratio", change.time_constant_ratio},
                                {"dead_time_error", change.dead_time_error_s},
                                {"from", change.from_s},
                                {"until", end_of(change.until_s)}});
  truth["plant"] = hidden_plant_json(setup.scenario.plant, unit);
  truth["noise"] = Json::array();
  for (const config::NoiseChange& change : setup.scenario.noise)
    truth["noise"].push_back(noise_json(change));
  truth["disturbances"] = Json::array();
  for (const config::Disturbance& disturbance : setup.scenario.disturbances)
    truth["disturbances"].push_back(disturbance_json(disturbance));
  truth["setpoints"] = setpoints_json(setup.scenario);
  truth["controller_off"] = Json::array();
  for (const config::TimeSpan& off : setup.scenario.controller_off)
    truth["controller_off"].push_back({{"from", off.from_s}, {"until", end_of(off.until_s)}});
  for (const config::TestSignal& test : setup.scenario.tests)
    truth["tests"].push_back({{"mv", test.mv},
                              {"size", test.size},
                              {"hold", test.hold_s},
                              {"random", test.random},
                              {"from", test.from_s},
                              {"until", end_of(test.until_s)}});
  if (!unit.simulation.process.empty()) {
    truth["process"] = {{"name", unit.simulation.process}, {"changes", Json::array()}};
    for (const config::ProcessChange& change : setup.scenario.process)
      truth["process"]["changes"].push_back({{"quantity", change.quantity},
                                             {"value", change.value},
                                             {"from", change.from_s},
                                             {"until", end_of(change.until_s)}});
  }
  truth["mv_limits"] = mv_limits_json(setup);
  truth["bad_data"] = bad_data_json(setup, filter);
  if (!unit.simulation.process.empty()) return text_of(truth);  // of its gains nothing is known
  const GainAgreement gains = compare_gains(
      operating_gain(setup.controller_model, mvs),
      operating_gain(
          plant_stages(plant_model(unit, setup.scenario.plant), setup.changes).back().model, mvs),
      unit.simulation.cv_weights);
  truth["determinant"] = {{"model", or_null(gains.model_determinant)},
                          {"plant", or_null(gains.plant_determinant)}};
  return text_of(truth);
}

}  // namespace mpm::sim
