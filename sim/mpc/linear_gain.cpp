#include "sim/mpc/linear_gain.hpp"

namespace mpm::sim {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

double slope_of(const std::optional<InputBlock>& block) {
  const auto* polynomial = block ? std::get_if<Polynomial>(&*block) : nullptr;
  if (polynomial == nullptr) return 1.0;
  return polynomial->coefficients.empty() ? 0.0 : polynomial->coefficients[0];
}

}  // namespace

MatrixXd static_slopes(const ModelSpec& spec) {
  MatrixXd slopes = MatrixXd::Ones(spec.cv_count, spec.input_count);
  for (std::size_t i = 0; i < spec.input_blocks.size(); ++i)
    slopes.col(static_cast<Index>(i)) *= slope_of(spec.input_blocks[i]);
  for (const ChannelSpec& channel : spec.channels)
    slopes(channel.cv, channel.input) *= slope_of(channel.input_block);
  for (std::size_t i = 0; i < spec.output_blocks.size(); ++i) {
    if (!spec.output_blocks[i]) continue;
    const auto* scale = std::get_if<Scale>(&*spec.output_blocks[i]);
    if (scale != nullptr) slopes.row(static_cast<Index>(i)) *= scale->factor;
  }
  return slopes;
}

MatrixXd operating_gain(const ModelSpec& spec, int mv_count) {
  const LinearModel model(spec);
  MatrixXd gain = model.steady_gain().cwiseProduct(static_slopes(spec)).leftCols(mv_count);
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating =
      model.integrating().leftCols(mv_count);
  for (Index cv = 0; cv < gain.rows(); ++cv) {
    if (!integrating.row(cv).any()) continue;
    for (Index mv = 0; mv < mv_count; ++mv)
      if (!integrating(cv, mv)) gain(cv, mv) = 0.0;
  }
  return gain;
}

}  // namespace mpm::sim
