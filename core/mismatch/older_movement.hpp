#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/mismatch/regression_history.hpp"

namespace mpm {

class Archive;

/// Tells when what is older than nearly two memories, and so forgotten but for a little, still
/// outweighs what an input has done since: it moved then as it never does (a gateway that sent
/// another unit for a while), and would say what its channels are for many memories more. An input
/// that has come to rest is left alone, for old rows are all that is known of it.
///
/// No allocation after construction.
class OlderMovement {
 public:
  /// `lambda`: of the longest memory, per sample; 1 where it forgets otherwise, and nothing is
  /// told. `remembered`: samples that the history holds.
  OlderMovement(const RegressionShape& shape, double lambda, int remembered);

  /// After the history took a sample; true where what is older than the last `depth` samples
  /// outweighs an input (it looks now and then), and from then on it is as if it had not been.
  [[nodiscard]] bool outweighs(const RegressionHistory& history);

  [[nodiscard]] int depth() const { return depth_; }

  void archive(Archive& a);

 private:
  /// Of the inputs' columns: about the mean, rows fading.
  struct Squares {
    explicit Squares(Eigen::Index columns)
        : mean(Eigen::VectorXd::Zero(columns)), square(Eigen::VectorXd::Zero(columns)) {}
    void take(const Eigen::VectorXd& row, double lambda);
    void clear();
    void archive(Archive& a);
    double rows = 0.0;
    Eigen::VectorXd mean, square;
  };
  [[nodiscard]] bool rests(int input, const RegressionHistory& history) const;

  int inputs_;
  int block_;
  double lambda_;
  int depth_;
  Squares all_, remembered_;
  Eigen::VectorXd row_;
  std::int64_t samples_ = 0;
};

}  // namespace mpm
