#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/ball_least_squares.hpp"
#include "core/mismatch/block_covariance.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/error_reduction.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/input_estimates.hpp"
#include "core/mismatch/signature.hpp"
#include "core/mismatch/usual_error_space.hpp"
#include "core/model/linear_model.hpp"
#include "core/regression/givens_qr.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// How much of a channel's step response is wrong, whatever the error's kind: the root mean square
/// of the error over that of the model's response, both until half as long again as it takes to
/// come within 5 % of its end; later values count, but less and less. A model that is that near is
/// good enough for control, though a dead time of it may surely be off. Where the model has no
/// channel nothing is near. No allocation after construction.
class StepErrors {
 public:
  StepErrors(const RegressionShape& shape, const LinearModel& model);

  /// Of errors of gain, logarithm of the time constants and dead time, as small as they are fitted;
  /// `shift`: which way the dead time goes (error_column). `variance`: of the noise.
  [[nodiscard]] Estimate of_fit(int cv, int input, const ReducedErrors& reduced, int shift,
                                double variance) const;
  /// Of an error of the pulse response, `BlockBasis::length` values.
  [[nodiscard]] double of_pulse(int cv, int input, const Eigen::VectorXd& pulse) const;

  /// What has been estimated of a channel: whitened; `usual` is the space that the directed test
  /// looks at.
  struct Target {
    int cv = 0, input = 0;
    const Eigen::Ref<const Eigen::VectorXd> estimate;
    const UsualErrorSpace& usual;
    const EstimateNoise& noise;
  };
  /// p-value of "off by no more than `limit`", an error of any kind: both tests of the channel, the
  /// distance from the nearest such error taking the place of the distance from none. The estimate
  /// is of the block's coefficients.
  [[nodiscard]] double beyond(const Target& target, const InputEstimates& estimates,
                              const BlockCovariance& covariance, double limit);
  /// The same of an estimate that lies among usual errors (`JointErrors::Channel`).
  [[nodiscard]] double beyond(const Target& target, const Eigen::MatrixXd& usual_errors,
                              double limit);

 private:
  struct Channel {
    double end = 0.0;                // samples; what is later counts less
    double norm = 0.0;               // of the model's weighted step response; 0 = no channel
    Eigen::MatrixXd usual;           // R of the usual errors' weighted step responses / norm
    Eigen::Matrix3d later, earlier;  // the same of gain, time constants and a shift
  };
  /// One geometry of estimates: as many unknowns as coordinates.
  struct Space {
    explicit Space(int size) : responses(Eigen::MatrixXd::Zero(size, size)), nearest(size) {}
    Eigen::MatrixXd responses;  // whitened, per unit of weighted step response
    BallLeastSquares nearest;
  };

  [[nodiscard]] const Channel& channel(int cv, int input) const {
    return channels_[static_cast<std::size_t>(input * cvs_ + cv)];
  }
  [[nodiscard]] double weight(const Channel& channel, Eigen::Index at) const;
  [[nodiscard]] Eigen::VectorXd sampled_step(const Eigen::VectorXd& pulse) const;
  [[nodiscard]] Channel channel_of(const Eigen::VectorXd& pulse, bool integrates) const;
  [[nodiscard]] double beyond(const Target& target, Space& space, double limit);

  int cvs_;
  BlockBasis basis_;
  std::vector<int> lags_;        // at which step responses are looked at
  std::vector<double> weights_;  // roots of the lags that each stands for
  std::vector<Channel> channels_;
  std::vector<Signature> units_;  // of each of the block's responses by itself
  Eigen::MatrixXd unit_steps_;    // lags x block
  Space block_, usual_;
  BallLeastSquares directed_;
  Eigen::VectorXd unit_;  // block
  Eigen::MatrixXd seen_;  // kUsualErrors x kUsualErrors
  Eigen::VectorXd seen_estimate_;
  RowFeed feed_;
  GivensQr steps_;   // of the block's weighted step responses
  GivensQr turned_;  // of what the directed test sees, transposed
};

}  // namespace mpm
