#pragma once

#include <Eigen/Core>

namespace mpm::sim {

/// What a controller acts on.
class Process {
 public:
  virtual ~Process() = default;

  /// Inputs that act: MVs, DVs, and aux signals where they do.
  [[nodiscard]] virtual int input_count() const = 0;
  /// Time of the present output on the clock of the data.
  virtual void set_time_s(double time_s) = 0;
  /// y(k) without noise.
  [[nodiscard]] virtual const Eigen::VectorXd& output() const = 0;
  /// Takes u(k), which acts until k+1.
  virtual void advance(const Eigen::Ref<const Eigen::VectorXd>& input) = 0;
  /// Aux signals that it measures itself, the unit's first ones.
  [[nodiscard]] virtual const Eigen::VectorXd& measured_aux() const { return nothing_; }

 private:
  Eigen::VectorXd nothing_;
};

}  // namespace mpm::sim
