#pragma once

#include <Eigen/Core>
#include <optional>

namespace mpm {

/// Whether a measured signal is a model's input over again: the flow behind a flow controller's
/// set-point, a valve's position behind its command. Such a signal explains what the input does,
/// and is no cause of its own. It is one where one input's last values explain most of what the
/// signal's own past does not; what disturbs from outside may move the inputs, but not after them.
/// `inputs`: samples x inputs; `signal`: samples; rows with unknown values are left out. False
/// where the rows are too few to tell.
[[nodiscard]] bool reads_back(const Eigen::Ref<const Eigen::MatrixXd>& inputs,
                              const Eigen::Ref<const Eigen::VectorXd>& signal);

/// What of a signal its own past does not explain, and one input's last values neither: a share of
/// the sum of squares, 0 to 1. Nothing where the rows are too few to tell, or the signal's past
/// explains all of it. As above.
[[nodiscard]] std::optional<double> share_left(const Eigen::Ref<const Eigen::VectorXd>& input,
                                               const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Rows that it takes to tell.
[[nodiscard]] int rows_to_read_back();

}  // namespace mpm
