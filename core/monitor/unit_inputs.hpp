#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/monitor/input_motion.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

/// The inputs of a unit, MVs first, then DVs: their values, what is taken where they are unknown,
/// and how they move.
class UnitInputs {
 public:
  /// `memory_samples`: over which their motion is told.
  UnitInputs(const SignalCounts& counts, double memory_samples);

  /// Takes a frame's.
  void read(const Frame& frame);

  /// NaN where unknown.
  [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }
  /// The last known values, 0 before the first.
  [[nodiscard]] const Eigen::VectorXd& held() const { return held_; }
  /// Samples for which an input has been unknown.
  [[nodiscard]] std::int64_t unknown_run(int input) const {
    return unknown_runs_[static_cast<std::size_t>(input)];
  }
  /// Longest of these.
  [[nodiscard]] std::int64_t longest_unknown_run() const;
  [[nodiscard]] bool at_limit(int input) const {
    return motions_[static_cast<std::size_t>(input)].at_limit();
  }
  /// No MV moves.
  [[nodiscard]] bool mvs_still() const;

  template <class Archive>
  void archive(Archive& a) {
    // not archived: mvs_ (construction)
    a(values_, held_, unknown_runs_, motions_);
  }

 private:
  int mvs_;
  Eigen::VectorXd values_, held_;
  std::vector<std::int64_t> unknown_runs_;
  std::vector<InputMotion> motions_;
};

}  // namespace mpm
