#pragma once

#include <Eigen/Core>

#include "core/identification/identification_data.hpp"

namespace mpm {

/// What the past of the other CVs' disturbances brings to each CV, and what is then known of its
/// gains.
struct CrossNoise {
  Eigen::MatrixXd brought;  ///< samples x CVs, mean 0
  /// CVs x inputs, own units: s.d. of the steady gains of the regression below (delta method); a
  /// fit that was given `brought` knows no better. 0 where nothing is brought.
  Eigen::MatrixXd gain_sd;
};

/// A controller answers all CVs, so where one disturbance moves several of them an input goes with
/// what is yet to come of a CV's noise, unless that noise is predicted from the past of all of
/// them: a fit of one CV that knows its own past alone finds the controller's inverse in place of
/// the plant, and is sure of it. All CVs are therefore regressed together on their past and on that
/// of the inputs, sound under any feedback as the orders grow (Ljung 1999, 13.4):
///
///     y(k) = sum_l A_l y(k-l) + sum_l B_l u(k-l) + e(k),  v(k) = sum_l A_l v(k-l) + e(k),
///
/// v what disturbs them, and of CV i
///
///     w_i(k) = sum_l A_l(i,i) w_i(k-l) + sum_l sum_(j != i) A_l(i,j) v_j(k-l) .
///
/// y_i - w_i is then the same plant, its noise driven by e_i alone. Of another CV j there is
/// something where its past helps beyond doubt (F test; Granger 1969). Zero where the rows do not
/// suffice or where what is found would not settle.
[[nodiscard]] CrossNoise cross_noise(const IdentificationData& data);

}  // namespace mpm
