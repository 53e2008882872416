#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/signature.hpp"
#include "core/model/linear_model.hpp"
#include "core/regression/givens_qr.hpp"

namespace mpm {

/// One CV's regression over one memory: the factor of its weighted rows and the sums of their
/// forgetting weights.
struct RegressionMemory {
  explicit RegressionMemory(int columns) : factor(columns, 1) {}

  GivensQr factor;
  double weight_sum = 0.0;     ///< W1 = sum lambda^age
  double weight_square = 0.0;  ///< W2 = sum lambda^(2 age)
  int rows = 0;

  /// Takes the first `count` rows of a batch, oldest first; consumes them.
  void update(RowBatch& batch, int count, double lambda) {
    factor.update_batch(batch, count, lambda);
    for (int k = 0; k < count; ++k) {
      weight_sum = lambda * weight_sum + 1.0;
      weight_square = lambda * lambda * weight_square + 1.0;
    }
    rows += count;
  }
  void clear() {
    factor.clear();
    weight_sum = weight_square = 0.0;
    rows = 0;
  }
  /// W1^2 / W2: rows that equal weights would need for the same precision.
  [[nodiscard]] double effective_rows() const {
    return weight_square > 0.0 ? weight_sum * weight_sum / weight_square : 0.0;
  }
  [[nodiscard]] double freedom() const { return effective_rows() - factor.columns(); }
  /// Enough rows for the evidence to mean anything. `heavy_tails`, 0..1, asks for more.
  [[nodiscard]] double needed_rows() const {
    return (calibration::rows_needed::kPerColumn +
            calibration::rows_needed::kMorePerColumn * heavy_tails) *
           factor.columns();
  }
  [[nodiscard]] bool ready() const {
    return rows >= needed_rows() && freedom() >= factor.columns();
  }
  double heavy_tails = 0.0;
};

/// Reads off a CV's factor what the data say about each of its channels.
///
/// Two tests are made and the smaller p counts, doubled: F over an input's whole block, which sees
/// any error, and F over the few directions in it that errors of gain, time constant and dead time
/// of the model's own channel would take (`usual_errors`), which sees those sooner. Either way the
/// other inputs' blocks are free, so that no error of theirs leaks in. Forgetting makes the
/// estimate noisier than equal weights would: F is multiplied by W1 / W2 and has
/// W1^2 / W2 - columns degrees of freedom.
///
/// Materiality. Where errors of gain, time constant and dead time explain what is seen, each is
/// tested against its limit (one-sided t, three times). Where they do not, both tests are made
/// again of the hypothesis that the error is some combination of these three within their limits:
/// the distance from the estimate to the nearest such error takes the place of the distance to
/// none.
///
/// The factor is never squared: with R_t the trailing triangle of all inputs' columns and
/// T = R_t^-1, the factor S of block i's covariance (S S' = T_i T_i', T_i the block's rows of T)
/// comes from reflecting what T_i has behind the block into the block's own triangle.
class ChannelEvaluator {
 public:
  /// `model` says what a gain error of 100 % in a channel looks like. Where it has no channel,
  /// 100 % is a first-order lag with the slowest tail that moves the CV as much as its other
  /// inputs do (or, where it has none, as much as the residual moves). `limits`: one per channel,
  /// input-major, or one for all.
  ChannelEvaluator(const RegressionShape& shape, const LinearModel& model,
                   std::vector<MaterialityLimits> limits);

  /// Evidence of all inputs to one CV into `evidence` (as many as inputs); the memory is ready.
  void evaluate(int cv, const RegressionMemory& memory, ChannelEvidence* evidence);

 private:
  struct Channel {
    std::vector<Signature> errors;  // of a 100 % gain error first
    std::vector<Signature> shifts;  // one sample later, one earlier, minus the response itself
    double gain = 0.0;  // steady gain (integrating: rise in the slowest tail's time constant)
    MaterialityLimits limits;
  };
  /// Three error directions as an orthonormal basis times r, and what they say of a target:
  /// |target - columns x|^2 = rest_square + |c - r x|^2.
  struct Reduced {
    Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
    Eigen::Vector3d c = Eigen::Vector3d::Zero();
    double rest_square = 0.0;
  };
  struct Scale {
    double
        variance;  // of the estimate's noise: residual variance, inflated by forgetting, few rows
    double block_variance;  // the same for the whole block at once
    double freedom;
  };

  void read_factor(int cv, const GivensQr& factor);
  void invert_triangle();
  void factor_covariance(int input);
  void judge(int cv, int input, const Scale& scale, ChannelEvidence& evidence);
  void judge_usual_errors(const Channel& channel, const Scale& scale, ChannelEvidence& evidence);
  void judge_materiality(const Channel& channel, const Scale& scale, ChannelEvidence& evidence);
  void judge_unusual(const MaterialityLimits& limits, const Scale& scale,
                     ChannelEvidence& evidence);
  Reduced reduce(const Eigen::Ref<const Eigen::VectorXd>& target,
                 const Eigen::Ref<const Eigen::MatrixXd>& columns, int shift);
  void estimate_free_gain(const Channel& channel, const Scale& scale, ChannelEvidence& evidence);
  void find_confounder(int input, ChannelEvidence& evidence);
  /// x <- S^-1 x and x <- S'^-1 x
  void whiten(Eigen::Ref<Eigen::VectorXd> x) const;
  void whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const;
  /// The error's coefficients on the block, whitened.
  void whiten_error(const Signature& error, int input, Eigen::Ref<Eigen::VectorXd> out);
  /// The gain-error estimate of an input (of the CV last evaluated) as weights on the factor's
  /// rotated responses; two such estimates are correlated as these vectors are.
  void gain_functional(int input, Eigen::Ref<Eigen::VectorXd> functional) const;
  [[nodiscard]] double reference_gain(int cv, int input) const;
  [[nodiscard]] double* inverse_row(int i) const {
    return inverse_.get() + static_cast<std::size_t>(i) * static_cast<std::size_t>(padded_);
  }

  RegressionShape shape_;
  int block_;
  int lead_in_;
  int input_ = 0;                  // whose block is factored
  std::vector<Channel> channels_;  // input-major

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  int padded_;                        // columns of all inputs, rounded up to whole granules
  RowMajor triangle_;                 // R_t, columns scaled to norm 1; padded with zeros
  AlignedArray inverse_;              // T, likewise
  Eigen::VectorXd norms_;             // of the columns
  Eigen::VectorXd scales_;            // 1 / norms_
  Eigen::VectorXd rotated_;           // the CV's rotated responses of those rows
  Eigen::VectorXd estimate_;          // scaled coefficients
  Eigen::VectorXd coefficients_;      // of the whole regression
  const double* own_lags_ = nullptr;  // a_1..a_p of the CV's own residual, in coefficients_
  double residual_norm_ = 0.0;        // of the CV's own last residual
  RowMajor covariance_;         // S: S S' = T_i T_i', covariance of block i's scaled coefficients
  AlignedArray behind_;         // of T_i, columns behind the block; then their reflectors
  std::vector<double> shares_;  // of the rows above in a reflector
  Eigen::MatrixXd direction_;   // B x m: weights of the gain-error estimate on the block
  Eigen::MatrixXd usual_;       // orthonormal basis of the usual errors, whitened
  int usual_rank_ = 0;
  Eigen::MatrixXd generators_;  // whitened: 100 % gain, ln time constant, sample later, earlier
  Eigen::MatrixXd usual_generators_;  // the generators in the coordinates of usual_
  Eigen::VectorXd usual_whitened_;    // the estimate, likewise
  Eigen::MatrixXd reduced_basis_;     // of `reduce`
  Eigen::VectorXd beta_, whitened_, whitened_beta_;
  Eigen::VectorXd functional_, other_functional_;
};

}  // namespace mpm
