#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mismatch/channel_signatures.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/input_errors.hpp"
#include "core/mismatch/input_estimates.hpp"
#include "core/mismatch/signature.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// One CV's regression under the hypothesis that no channel has more than usual errors: the
/// coefficients of each input lie in the span of its `usual_errors`, a handful of numbers instead
/// of a whole block. What the other inputs' blocks could do by chance then hides far less of a
/// channel. Whether the hypothesis may stand is tested first, by F on all that it leaves of the
/// inputs' coefficients (Seber and Lee 2003, section 4.1); that is independent of what is then
/// tested within it.
///
/// With R_t the triangle of `InputEstimates` and X_i the usual errors as scaled coefficients, the
/// factor of [R_t X_1 .. R_t X_n | z, R_t s_1 ..] has all of it; s_i are shifts by one sample, to
/// be expressed in usual errors. No allocation after construction.
class JointErrors {
 public:
  explicit JointErrors(const RegressionShape& shape);

  /// Takes the CV whose factor `estimates` has read. `signatures`: of all channels, input-major.
  /// What an error adds depends on the CV's own lags: they are learnt beside the usual errors, by
  /// turns, and where the hypothesis may stand `estimates` gets them.
  void read(int cv, const GivensQr& factor, const std::vector<ChannelSignatures>& signatures,
            const EstimateNoise& noise, InputEstimates& estimates);
  /// Whether usual errors explain all that the inputs do.
  [[nodiscard]] bool adequate() const { return adequate_; }
  /// What they leave of all that the inputs explain, in squares.
  [[nodiscard]] double left_square() const { return all_.residual_square(0); }

  /// As coefficients, block x kUsualErrors of each input: what the rows of its block give with them
  /// is what such errors make of the residual beyond its own past.
  [[nodiscard]] const Eigen::MatrixXd& errors() const { return errors_; }

  using Channel = InputErrors::Channel;
  /// Valid until the next call.
  [[nodiscard]] const Channel& channel(int input) {
    return single_.read(all_, input * kUsualErrors, 1 + input * InputErrors::kShifts);
  }

  /// The factor of [R_t X of the other inputs | R_t of this one's block | z]: `first` is the column
  /// where the block begins. Valid until the next call.
  struct Freed {
    const GivensQr& factor;
    int first;
  };
  [[nodiscard]] Freed freed(int input, const InputEstimates& estimates);

 private:
  void fit(int cv, const std::vector<ChannelSignatures>& signatures, const EstimateNoise& noise,
           const InputEstimates& estimates);
  void move(int cv, const InputEstimates& estimates,
            const std::vector<ChannelSignatures>& signatures);
  void learn_own_lags(const GivensQr& factor);

  RegressionShape shape_;
  bool adequate_ = false;
  Eigen::MatrixXd moved_;    // columns of all inputs x errors of all inputs: R_t X
  Eigen::MatrixXd shifts_;   // columns of all inputs x 2 of each: R_t s, later and earlier
  Eigen::MatrixXd errors_;   // block x errors of all inputs: X, unscaled
  Eigen::VectorXd error_;    // block
  Eigen::VectorXd sizes_;    // of the errors of all inputs
  Eigen::VectorXd lead_in_;  // coefficients
  Eigen::VectorXd own_past_, learnt_;
  RowFeed feed_;
  GivensQr all_;    // [R_t X | z, R_t s]
  GivensQr freed_;  // [R_t X of all but one | R_t of its block | z]
  InputErrors single_;
};

}  // namespace mpm
