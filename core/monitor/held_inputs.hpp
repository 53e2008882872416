#pragma once

#include <Eigen/Core>

#include "core/model/linear_model.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

/// Whether what a historian's deadband took from the inputs weighs in a CV that is simulated from
/// them. An input that was held within d of where it was is off by d / sqrt(3) (s.d.), and what a
/// lag of T samples makes of an error that lasts h samples has tanh(h / 2T) of its variance (by
/// summing the squares of a pulse's answer). Controllers that move a valve in steps hold inputs,
/// too, without anything lost: seldom and by little, as seen from the CV.
class HeldInputs {
 public:
  explicit HeldInputs(const LinearModel& model);

  /// The input whose deadband weighs most, where it is more than `share` of `noise`, the s.d. of
  /// the CV's one-step errors; -1 where none does or that is not known (0).
  [[nodiscard]] int heaviest(int cv, const Screen& screen, double noise, double share) const;

 private:
  Eigen::MatrixXd gains_;           // cvs x inputs; infinite where a channel integrates
  Eigen::MatrixXd time_constants_;  // likewise, samples
};

}  // namespace mpm
