#include "tests/hidden/loop.hpp"

#include <vector>

#include "sim/mpc/mpc.hpp"
#include "sim/signals/setpoints.hpp"

namespace mpm::hidden {

using Eigen::Index;
using Eigen::VectorXd;

LoopRecord run_loop(const config::UnitConfig& unit, const TruePlantSpec& spec,
                    const Surroundings& around, std::uint64_t seed) {
  const auto mvs = static_cast<Index>(unit.mv.size());
  const Index samples = around.noise.rows();
  std::vector<sim::SetpointSource> sources;
  for (std::size_t cv = 0; cv < unit.cv.size(); ++cv)
    sources.push_back({unit.simulation.setpoints.at(cv), cv});
  sim::RandomBinarySetpoints setpoints(sources, spec.output_origin, seed);
  sim::Mpc controller(unit.model, static_cast<int>(mvs), unit.simulation, 1.0);
  TruePlant plant(spec);
  plant.rest_at(around.aux.row(0));

  LoopRecord record;
  record.inputs.resize(samples, unit.model.input_count);
  record.cvs.resize(samples, unit.model.cv_count);
  VectorXd input(unit.model.input_count);
  for (Index k = 0; k < samples; ++k) {
    const VectorXd measured = plant.measured(around.noise.row(k));
    const VectorXd disturbance = around.dvs.row(k);
    input.head(mvs) = controller.control(measured, setpoints.next(), disturbance);
    input.tail(disturbance.size()) = disturbance;
    record.cvs.row(k) = measured;
    record.inputs.row(k) = input;
    if (!measured.allFinite() || !input.allFinite()) {
      record.finite = false;
      return record;
    }
    plant.advance(input, around.aux.row(k));
  }
  return record;
}

}  // namespace mpm::hidden
