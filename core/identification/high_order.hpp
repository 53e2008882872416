#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/identification_data.hpp"

namespace mpm {

/// Lags of an input that share one coefficient: first .. last, first >= 1.
struct LagBlock {
  int first = 1;
  int last = 1;
};

/// Single lags at first, then blocks that grow with the lag, up to `longest`: an answer of any
/// speed in few coefficients.
[[nodiscard]] std::vector<LagBlock> lag_blocks(int longest);

/// The longest lag that runs of such a length bear, samples.
[[nodiscard]] int longest_lag(const IdentificationData& data);

/// Rows of which `past` rows before them in their run and they themselves are known (`known`: 1 or
/// 0), none of the first `skipped` of a run.
[[nodiscard]] std::vector<Eigen::Index> rows_with_past(const std::vector<Run>& runs,
                                                       const Eigen::VectorXd& known, int past,
                                                       Eigen::Index skipped);

/// Sums of an input over the blocks, samples x blocks; before a run its first value held.
[[nodiscard]] Eigen::MatrixXd lagged_sums(const Eigen::Ref<const Eigen::VectorXd>& input,
                                          const std::vector<LagBlock>& blocks,
                                          const std::vector<Run>& runs);

/// One CV regressed on its own past and on the past of all inputs, a level for each run taken out:
///   y(k) = sum a_m y(k - m) + sum_i sum_b c_ib sum_{l in b} u_i(k - l) + e(k).
/// Consistent in closed loop as the orders grow, whatever the feedback, since no lag is below 1
/// (Ljung 1999, 13.4; Zhu 2001, ch. 4). Only the orthogonal factor is kept: what any model of lower
/// order leaves of the data follows from it.
struct HighOrderModel {
  std::vector<LagBlock> blocks;
  int past = 0;            ///< lags of the CV itself: the first columns
  Eigen::VectorXd noise;   ///< a_1 .. a_past
  Eigen::MatrixXd factor;  ///< columns x columns, upper triangular
  Eigen::VectorXd right;   ///< columns: the CV, rotated alike
  double variance = 0.0;   ///< of e
  double rows = 0.0;       ///< that were used
  bool sound = false;      ///< enough rows, and something left to explain

  [[nodiscard]] Eigen::Index column_of(int input) const {
    return past + static_cast<Eigen::Index>(input) * static_cast<Eigen::Index>(blocks.size());
  }
};

/// `past`: lags of the CV itself, fewer where the rows do not suffice. With none it is a finite
/// impulse response, sound only where no feedback moves the inputs.
[[nodiscard]] HighOrderModel high_order_model(const IdentificationData& data, int cv, int past);

}  // namespace mpm
