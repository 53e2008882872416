#include "core/monitor/feedback_correction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {

namespace limits = calibration::feedback_correction;

void FeedbackCorrection::take(double measured, double predicted, double simulated) {
  const Sample now{measured, predicted, simulated};
  if (known_ == 2) add_row(now);
  known_ = std::min(known_ + 1, 2);
  before_last_ = std::exchange(last_, now);
}

void FeedbackCorrection::add_row(const Sample& now) {
  if (rows_ == 0) level_ = last_.bias();
  const double move = now.bias() - last_.bias(), moved = now.measured - last_.measured;
  double* row = factor_.row();
  row[0] = 1.0;
  row[1] = last_.bias() - level_;
  row[2] = last_.bias() - before_last_.bias();
  row[3] = now.simulated - last_.simulated;
  row[4] = last_.simulated - before_last_.simulated;
  row[kLast] = last_.residual();
  row[kColumns] = move;
  factor_.update(1.0);
  moves_ += moved * moved;
  bias_moves_ += move * move;
  residuals_ += now.residual() * now.residual();
  if (++rows_ == limits::kBlock) end_block();
}

double FeedbackCorrection::block_share() const {
  if (residuals_ < limits::kSame * moves_)  // the measurement itself
    return bias_moves_ > limits::kMovesShare * moves_ ? 1.0 : 0.0;
  double by_others = 0.0;
  for (int i = 1; i < kLast; ++i) by_others += factor_.z(i, 0) * factor_.z(i, 0);
  const double by_residual = factor_.z(kLast, 0) * factor_.z(kLast, 0);
  const double left = factor_.residual_square(0), all = by_others + by_residual + left;
  if (!(by_residual > limits::kOfResidual * all) || left > limits::kLeft * (by_residual + left))
    return 0.0;
  Eigen::Vector<double, kColumns> coefficients;
  factor_.solve(0, factor_.columns(), coefficients);
  const double share = coefficients(kLast);
  if (!(share >= limits::kSmallest && share <= limits::kLargest)) return 0.0;
  return std::abs(coefficients(1)) <= limits::kSides * share ? share : 0.0;
}

void FeedbackCorrection::end_block() {
  const double share = block_share();
  const bool says = share > 0.0;
  const bool agrees = says && std::abs(share - share_) <= limits::kAgree * share;
  // It begins where two blocks in a row say the same, and is over after some that do not.
  if (corrected_)
    agreeing_ = says ? 0 : agreeing_ + 1;
  else
    agreeing_ = agrees ? agreeing_ + 1 : 0;
  if (says || !corrected_) share_ = share;
  if (agreeing_ >= (corrected_ ? limits::kBlocksOver : 1)) {
    corrected_ = !corrected_;
    agreeing_ = 0;
  }
  factor_.clear();
  rows_ = 0;
  moves_ = bias_moves_ = residuals_ = 0.0;
}

void FeedbackCorrection::archive(Archive& a) {
  a(factor_, last_, before_last_, level_, moves_, bias_moves_, residuals_, share_, corrected_);
  a.within(known_, 0, 2);
  a.within(rows_, 0, limits::kBlock);
  a.within(agreeing_, 0, limits::kBlocksOver);
}

}  // namespace mpm
