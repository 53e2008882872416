#pragma once

#include <memory>

#include "sim/plant/recovery_boiler/boiler.hpp"

namespace mpm::sim::boiler {

/// The boiler in time: a stiff system (burning gas takes milliseconds, the char bed a quarter of an
/// hour), integrated by SUNDIALS CVODE (backward differentiation, dense Newton).
class RunningBoiler {
 public:
  /// From rest at these inputs. `tolerance`: relative, of each state. Throws std::runtime_error
  /// where the solver fails.
  explicit RunningBoiler(const Inputs& inputs = {}, const Condition& condition = {},
                         double tolerance = 1e-7);
  ~RunningBoiler();
  RunningBoiler(const RunningBoiler&) = delete;
  RunningBoiler& operator=(const RunningBoiler&) = delete;

  /// Inputs and condition are held for so many seconds.
  void advance(const Inputs& inputs, const Condition& condition, double seconds);

  [[nodiscard]] const States& states() const { return states_; }
  /// As sensors without dynamics see it now.
  [[nodiscard]] const Streams& streams() const { return streams_; }

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
  States states_;
  Streams streams_;
};

}  // namespace mpm::sim::boiler
