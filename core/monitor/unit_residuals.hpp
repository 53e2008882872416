#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/signal/frame.hpp"

namespace mpm {

/// The residuals of a unit, and what is taken where they are unknown. What rounding alone makes of
/// a prediction that is exact is no residual: 0.
class UnitResiduals {
 public:
  explicit UnitResiduals(int cvs);

  /// Takes a frame's: measured minus predicted; `predicted`: per CV, NaN where unknown.
  void read(const Frame& frame, const Eigen::VectorXd& predicted);
  /// `missing` intervals of which nothing is known.
  void skip(std::int64_t missing);

  /// NaN where unknown.
  [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }
  /// The last known values, 0 before the first.
  [[nodiscard]] const Eigen::VectorXd& held() const { return held_; }
  /// Samples for which one has been unknown, and the longest of these.
  [[nodiscard]] std::int64_t unknown_run(int cv) const {
    return unknown_runs_[static_cast<std::size_t>(cv)];
  }
  [[nodiscard]] std::int64_t longest_unknown_run() const;

  template <class Archive>
  void archive(Archive& a) {
    a(values_, held_, largest_, unknown_runs_);
  }

 private:
  Eigen::VectorXd values_, held_;
  Eigen::VectorXd largest_;  // magnitude that each CV has had
  std::vector<std::int64_t> unknown_runs_;
};

}  // namespace mpm
