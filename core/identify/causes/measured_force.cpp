#include "core/identify/causes/measured_force.hpp"

#include <cmath>

#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/triangle.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What a channel makes of these moves of its input, from rest on.
VectorXd answer(const ChannelSpec& channel, double sample_time_s, const VectorXd& moves) {
  LinearModel model(alone(channel, sample_time_s));
  VectorXd input = VectorXd::Zero(1), output(moves.size());
  model.reset_steady(input);
  for (Index k = 0; k < moves.size(); ++k) {
    output(k) = model.output()(0);
    input(0) = moves(k);
    model.advance(input);
  }
  return output;
}

}  // namespace

Eigen::Vector2d measured_force(const Outlook& outlook, const ChannelSpec& channel) {
  Problem& problem = outlook.problem;
  const CvFit& fit = outlook.without[static_cast<std::size_t>(channel.cv)];
  const CvData& data = problem.data(channel.cv);
  const double sample_time_s = outlook.sample_time_s();
  const VectorXd simulated = problem.simulate(outlook.accepted, channel.cv);
  const VectorXd misfit = (data.measured - simulated).cwiseProduct(data.known);
  const VectorXd input = outlook.recording().inputs.col(channel.input);
  const double rest = outlook.model().input_origin(channel.input);
  VectorXd moves(input.size());
  double last = rest;
  for (Index k = 0; k < input.size(); ++k) {
    if (std::isfinite(input(k))) last = input(k);
    moves(k) = last - rest;
  }
  const VectorXd own = answer(channel, sample_time_s, moves) + misfit;

  const Index samples = own.size(), small = data.nuisances.cols(), forces = 2;
  const WhitenedRows rows_of(data, fit);
  MatrixXd system = MatrixXd::Zero(samples + small, small + forces + 1);
  for (Index b = 0; b < small; ++b) {
    system.col(b).head(samples) = rows_of(data.nuisances.col(b));
    system(samples + b, b) = 1.0;
  }
  const VectorXd square = own.cwiseAbs2();
  system.col(small).head(samples) = rows_of(-answer(channel, sample_time_s, square));
  system.col(small + 1).head(samples) =
      rows_of(-answer(channel, sample_time_s, square.cwiseProduct(own)));
  system.col(small + forces).head(samples) = rows_of(misfit);
  const MatrixXd r = triangle(system);
  const Eigen::Vector2d force = r.block<2, 2>(small, small)
                                    .triangularView<Eigen::Upper>()
                                    .solve(r.block<2, 1>(small, small + forces));
  return force.allFinite() ? force : Eigen::Vector2d::Zero();
}

}  // namespace mpm
