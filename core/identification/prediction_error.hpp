#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/channel_shape.hpp"
#include "core/identification/identification_data.hpp"
#include "core/identify/fit/whitening.hpp"

namespace mpm {

/// How the noise of a CV is taken.
struct NoiseAssumption {
  NoiseModel model;
  /// By how much the variance of an estimate is larger than if the innovations were white: 1 with a
  /// noise model that whitens; without one (errors of the free run) what autocorrelation makes it.
  double inflation = 1.0;
};

/// One CV explained by some channels.
struct PredictionErrorFit {
  std::vector<ChannelShape> channels;
  Whitening noise;
  double variance = 1.0;  ///< of the innovations
  double rows = 0.0;      ///< of innovations, over the inflation
  double cost = 0.0;      ///< -2 ln likelihood: rows ln variance
  /// Of the channels' free numbers, channel after channel.
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residual;     ///< CV minus model and first state; 0 where unknown
  Eigen::VectorXd innovations;  ///< whitened; 0 where they cannot be had
  Eigen::VectorXd weights;      ///< 1 where they can
  Eigen::VectorXd level;        ///< of each run, deviations
  double drift = 0.0;           ///< CV units per sample: of an integrating CV beside its inputs
  Eigen::MatrixXd slopes;       ///< whitened derivatives by the free numbers, per s.d. of e
};

/// Maximum likelihood of one CV's channels: the model runs freely, what it leaves is
/// autoregressive noise, and both are fitted together (Gauss-Newton, orthogonal; Ljung 1999, 10.2).
/// Sound in closed loop as far as the noise model holds. Every run has a level and a first state of
/// its own, and of an integrating CV a drift.
[[nodiscard]] PredictionErrorFit fit_prediction_error(const IdentificationData& data, int cv,
                                                      std::vector<ChannelShape> channels,
                                                      const NoiseAssumption& noise, int most_steps);

/// Fall of -2 ln likelihood that a channel has to be worth in so many rows: what BIC takes for its
/// numbers (Schwarz 1978).
[[nodiscard]] double needed_of_channel(double rows);

/// Innovations are the errors of the free run: sound only where no feedback moves the inputs.
[[nodiscard]] NoiseAssumption output_error();
/// The same with the inflation that a fit's errors show.
[[nodiscard]] NoiseAssumption output_error(const PredictionErrorFit& fit);

}  // namespace mpm
