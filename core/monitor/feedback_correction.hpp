#pragma once

#include "core/regression/givens_qr.hpp"

namespace mpm {

class Archive;

/// Whether the predictions that come for one CV are corrected by its measurement, as the
/// output-bias update of an MPC does: p(k) = s(k) + b(k), b(k) = b(k-1) + K (y(k-1) - p(k-1)), with
/// s what the model makes of the inputs (Qin and Badgwell 2003, section 4.2; K = 1 in DMC), or
/// whether they are the measurement itself. Residuals of such predictions have lost what a wrong
/// gain does to them. Blocks of samples are asked: a correction follows the last residual and
/// nothing else, in two blocks alike; where the model that predicts is another one than s, b
/// follows the inputs. No allocation after construction.
class FeedbackCorrection {
 public:
  FeedbackCorrection() : factor_(kColumns, 1) {}

  /// A sample, CV units, finite.
  void take(double measured, double predicted, double simulated);
  /// What was right before the next sample is not known.
  void skip() { known_ = 0; }

  /// As the last blocks say.
  [[nodiscard]] bool corrected() const { return corrected_; }
  /// Share of the last residual by which predictions are corrected, 0..1; of the last block that
  /// said so.
  [[nodiscard]] double share() const { return share_; }

  void archive(Archive& a);

 private:
  struct Sample {
    double measured = 0.0, predicted = 0.0, simulated = 0.0;
    [[nodiscard]] double bias() const { return predicted - simulated; }
    [[nodiscard]] double residual() const { return measured - predicted; }
    template <class Archive>
    void archive(Archive& a) {
      a(measured, predicted, simulated);
    }
  };
  void add_row(const Sample& now);
  void end_block();
  /// What the block at hand says: the share K; 0 of predictions that are not corrected.
  [[nodiscard]] double block_share() const;

  static constexpr int kColumns = 6, kLast = kColumns - 1;

  GivensQr factor_;  // of [1, bias, what the inputs move, the last residual | move of the bias]
  Sample last_, before_last_;
  int known_ = 0;            // of these two
  int rows_ = 0;             // of the block
  double level_ = 0.0;       // of the bias, at the block's beginning
  double moves_ = 0.0;       // squares of the measurement's moves, summed over the block
  double bias_moves_ = 0.0;  // of the bias'
  double residuals_ = 0.0;   // squares
  double share_ = 0.0;       // of the last block; while it is corrected, that had one
  int agreeing_ = 0;         // blocks in a row that say the same, up to what is asked
  bool corrected_ = false;
};

}  // namespace mpm
