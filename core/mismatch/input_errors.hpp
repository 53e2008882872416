#pragma once

#include <Eigen/Core>

#include "core/mismatch/error_reduction.hpp"
#include "core/mismatch/signature.hpp"
#include "core/regression/givens_qr.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// One channel's usual errors out of a factor of those of many, once all others are taken out. No
/// allocation after construction.
class InputErrors {
 public:
  /// Shifts of a channel's response that a factor has as responses, by one sample: later, earlier.
  static constexpr int kShifts = 2;

  /// `columns`: errors in the factor.
  explicit InputErrors(int columns);

  /// Whitened.
  struct Channel {
    Eigen::VectorXd estimate;    ///< kUsualErrors
    Eigen::MatrixXd usual;       ///< kUsualErrors x kUsualErrors: each usual error
    Eigen::MatrixXd directions;  ///< kUsualErrors x error_column::kCount
  };
  /// `own`: the channel's first column in `all`; `shift`: the response that has its shifts;
  /// response 0 is what is fitted. Valid until the next call.
  [[nodiscard]] const Channel& read(const GivensQr& all, int own, int shift);

 private:
  RowFeed feed_;
  GivensQr last_;  // the channel's columns last
  Channel channel_;
};

}  // namespace mpm
