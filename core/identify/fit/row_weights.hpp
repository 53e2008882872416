#pragma once

#include <Eigen/Core>

namespace mpm {

/// Weights of rows by their innovations, so that no stretch and no outlier decides: each is divided
/// by the variance around it relative to the whole (a robust one, over about 300 rows), and counts
/// less beyond three s.d. (Huber's weights squared, as in the channel test). Rows of weight zero
/// stay so.
void reweigh(const Eigen::Ref<const Eigen::VectorXd>& innovations, Eigen::VectorXd& weights);

}  // namespace mpm
