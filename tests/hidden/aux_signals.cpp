#include "tests/hidden/aux_signals.hpp"

#include <cmath>

#include "sim/signals/random_stream.hpp"

namespace mpm::hidden {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

VectorXd autoregression(sim::RandomStream& stream, int samples) {
  const double pole = std::exp(-1.0 / (20.0 + 180.0 * stream.uniform()));
  VectorXd result(samples);
  double value = stream.normal();
  for (Index k = 0; k < samples; ++k) {
    result(k) = value;
    value = pole * value + std::sqrt(1.0 - pole * pole) * stream.normal();
  }
  return result;
}

VectorXd random_steps(sim::RandomStream& stream, int samples) {
  const double change = 1.0 / (30.0 + 120.0 * stream.uniform());
  VectorXd result(samples);
  double value = stream.normal();
  for (Index k = 0; k < samples; ++k) {
    if (stream.uniform() < change) value = stream.normal();
    result(k) = value;
  }
  return result;
}

}  // namespace

Eigen::MatrixXd add_aux_signals(TruePlantSpec& plant, int count, int samples, std::uint64_t seed,
                                std::uint64_t attempt) {
  plant.aux_count = count;
  const Index inputs = plant.input_count;
  plant.input_origin.conservativeResize(inputs + count);
  plant.input_elements.resize(static_cast<std::size_t>(inputs + count));
  Eigen::MatrixXd aux(samples, count);
  for (Index i = 0; i < count; ++i) {
    sim::RandomStream stream(seed, sim::StreamPurpose::kDrift,
                             10 * attempt + static_cast<std::uint64_t>(i));
    const double level = 50.0 * stream.uniform();
    const double deviation = 0.5 + 4.5 * stream.uniform();
    const bool steps = stream.uniform() < 0.5;
    plant.input_origin(inputs + i) = level;
    aux.col(i) =
        level +
        deviation *
            (steps ? random_steps(stream, samples) : autoregression(stream, samples)).array();
  }
  return aux;
}

}  // namespace mpm::hidden
