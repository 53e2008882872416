#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/signature.hpp"
#include "core/model/linear_model.hpp"
#include "core/regression/givens_qr.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

/// What the data say about one channel (input i to CV j).
struct ChannelEvidence {
  double statistic = 0.0;             ///< F of the test that says more
  double p_value = 1.0;               ///< tests * P(F > statistic) where the channel matches, <= 1
  double numerator_freedom = 0.0;     ///< of F; 0 = nothing to test with
  int tests = 1;                      ///< that were made
  double block_statistic = 0.0;       ///< F of the whole block
  double reference_gain = 0.0;        ///< what 100 % means, CV units per input unit
  double gain_error_ratio = 0.0;      ///< (plant gain - model gain) / reference, were it only gain
  double excitation_index = 0.0;      ///< s.d. of gain_error_ratio; infinite = no information
  double excitation_index_alone = 0;  ///< the same, were the other inputs known not to matter
  int confounder = -1;                ///< input whose estimate is most correlated with this one's
};

/// Calibrated channel test. Per CV j the model residual e_j is regressed, in ARX form (the direct
/// method, valid in closed loop because the innovation w_j(k) is independent of the past), on
///
///     1,  e_1..e_n (k-1 .. k-p),  and per input i:  u_i(k-1 .. k-L), s_it(k-L-1), t = 1..tails,
///     s_it(k) = r_t s_it(k-1) + (1 - r_t) u_i(k),
///
/// and F tests that input i's block of B = L + tails coefficients is zero given all the others,
/// which is so exactly where channel (j, i) matches (Ljung 1999, section 13.4, for the regression;
/// Seber and Lee 2003, section 4.3, for F). Rows are weighted
///
///     lambda^age * min(1, 3 s / |r|)^2 / s^2,
///
/// r the row's one-step prediction error and s its running s.d., so that a change of the noise
/// level or heavy tails do not raise the false-alarm rate. Forgetting makes the estimate noisier
/// than equal weights would: with W1 = sum lambda^age, W2 = sum lambda^(2 age), F is multiplied by
/// W1 / W2 and has W1^2 / W2 - columns degrees of freedom.
///
/// Two tests are made and the smaller p counts, doubled: F over the whole block, which sees any
/// error, and F over the few directions in it that errors of gain, time constant and dead time of
/// the model's own channel would take (`usual_errors`), which sees those sooner. Either way the
/// other inputs' blocks are free, so that no error of theirs leaks in.
///
/// The factor is never squared: with R_t the trailing triangle of all inputs' columns and
/// T = R_t^-1, the factor S of block i's covariance (S S' = T_i T_i', T_i the block's rows of T)
/// comes from reflecting what T_i has behind the block into the block's own triangle.
class ChannelTest {
 public:
  struct Shape {
    int inputs = 1;
    int cvs = 1;
    int fir_lags = 20;               ///< L >= 1
    int residual_order = 8;          ///< p >= 1
    std::vector<double> tail_poles;  ///< r_t in (0, 1); at least one
  };

  /// `model` says what a gain error of 100 % in a channel looks like. Where it has no channel,
  /// 100 % is a first-order lag with the slowest tail that moves the CV as much as its other
  /// inputs do (or, where it has none, as much as the residual moves).
  ChannelTest(const Shape& shape, double lambda, const LinearModel& model);

  /// Takes u(k) (m values) and e(k) (n values), all finite, of the next interval. True where they
  /// gave a row.
  bool update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& residuals);
  /// `missing` intervals (>= 1) follow without usable values: inputs are taken as held, no row may
  /// span the gap.
  void skip(std::int64_t missing);

  /// Refreshes the evidence of all channels.
  void evaluate();
  [[nodiscard]] const ChannelEvidence& evidence(int cv, int input) const {
    return evidence_[static_cast<std::size_t>(input * shape_.cvs + cv)];
  }
  /// W1^2 / W2: rows that equal weights would need for the same precision.
  [[nodiscard]] double effective_rows() const;
  [[nodiscard]] double denominator_freedom() const { return effective_rows() - columns_; }
  /// Enough rows for the evidence to mean anything: with fewer than six per column the tail of F
  /// is too thin in closed loop (at four, p < 1e-4 came twenty times too often).
  [[nodiscard]] bool ready() const {
    return rows_ >= 6 * columns_ && denominator_freedom() >= columns_;
  }
  [[nodiscard]] int block_columns() const { return block_; }
  [[nodiscard]] int columns() const { return columns_; }

 private:
  /// One CV's regression.
  struct Response {
    explicit Response(int columns);
    GivensQr factor;
    Eigen::VectorXd coefficients;
    double scale = 1.0;       // running s.d. of the one-step error, CV units
    double scale_rows = 0.0;  // rows it rests on
    bool scaled = false;
  };
  struct Channel {
    std::vector<Signature> errors;  // of a 100 % gain error first
    double gain = 0.0;  // steady gain (integrating: rise in the slowest tail's time constant)
  };

  void build_row();
  void take_row(int cv, double residual);
  void evaluate_cv(int cv);
  void invert_triangle();
  void factor_covariance(int input);
  /// x <- S^-1 x and x <- S'^-1 x
  void whiten(Eigen::Ref<Eigen::VectorXd> x) const;
  void whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const;
  /// a_1..a_p of the CV's own residual
  [[nodiscard]] const double* own_lags(int cv) const;
  /// The directed test: replaces the evidence where it says more.
  void judge_usual_errors(int cv, int input, double variance, double freedom,
                          ChannelEvidence& evidence);
  /// The gain-error estimate of an input (of the CV last evaluated) as weights on the factor's
  /// rotated responses; two such estimates are correlated as these vectors are.
  void gain_functional(int input, Eigen::Ref<Eigen::VectorXd> functional) const;
  [[nodiscard]] int find_confounder(int input);
  [[nodiscard]] double reference_gain(int cv, int input) const;

  Shape shape_;
  double lambda_;
  int block_;    // B
  int lead_in_;  // columns before the inputs' blocks: 1 + n p
  int columns_;
  int filled_ = 0;
  int rows_ = 0;
  double weight_sum_ = 0.0;     // W1
  double weight_square_ = 0.0;  // W2
  bool has_origin_ = false;
  Eigen::VectorXd origin_;
  std::vector<LagWindow> input_windows_;
  std::vector<LagWindow> tail_windows_;  // input-major
  std::vector<LagWindow> residual_windows_;
  Eigen::VectorXd last_input_;
  Eigen::VectorXd row_;
  std::vector<Response> responses_;
  std::vector<Channel> channels_;
  std::vector<ChannelEvidence> evidence_;

  // Work space of evaluate_cv.
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  int padded_;                 // columns of all inputs, rounded up to whole granules
  RowMajor triangle_;          // R_t, columns scaled to norm 1; padded with zeros
  RowMajor inverse_;           // T, likewise
  Eigen::VectorXd norms_;      // of the columns
  Eigen::VectorXd scales_;     // 1 / norms_
  Eigen::VectorXd rotated_;    // the CV's rotated responses of those rows
  Eigen::VectorXd estimate_;   // scaled coefficients
  RowMajor covariance_;        // S: S S' = T_i T_i', covariance of block i's scaled coefficients
  RowMajor behind_;            // of T_i, columns behind the block; then their reflectors
  Eigen::MatrixXd direction_;  // B x m: weights of the gain-error estimate on the block
  Eigen::MatrixXd usual_;      // orthonormal basis of the usual errors, whitened
  Eigen::VectorXd beta_, whitened_, whitened_beta_;
  Eigen::VectorXd functional_, other_functional_;
};

}  // namespace mpm
