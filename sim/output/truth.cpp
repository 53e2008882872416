#include "sim/output/truth.hpp"

#include <nlohmann/json.hpp>

#include "sim/mpc/linear_gain.hpp"
#include "sim/scenario/stability.hpp"

namespace mpm::sim {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

}  // namespace

std::string truth_json(const LoopSetup& setup, const std::string& controller_file) {
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
                                {"from", change.from_s}});
  truth["noise"] = Json::array();
  for (const config::NoiseChange& change : setup.scenario.noise)
    truth["noise"].push_back({{"cv", change.cv ? Json(*change.cv) : Json(nullptr)},
                              {"sigma_ratio", change.sigma_ratio},
                              {"from", change.from_s}});
  const GainAgreement gains =
      compare_gains(operating_gain(setup.controller_model, mvs),
                    operating_gain(plant_stages(unit.model, setup.changes).back().model, mvs),
                    unit.simulation.cv_weights);
  truth["determinant"] = {{"model", or_null(gains.model_determinant)},
                          {"plant", or_null(gains.plant_determinant)}};
  return truth.dump(2) + "\n";
}

}  // namespace mpm::sim
