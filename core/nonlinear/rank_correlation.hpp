#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/nonlinear/rank_window.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// Rank correlations of all inputs, CVs and lags at once: Spearman's coefficient (1904) of u_i(t)
/// and e_j(t+d) over the last samples, or with the ranks of all other inputs at t held (Kendall
/// 1942), the rank form of (3.14) of Carlsson 2010. As `LaggedCorrelation` all rows end at
/// t = now - last_lag. No allocation after construction.
class RankCorrelation {
 public:
  struct Shape {
    int inputs = 1;  ///< m >= 1
    int cvs = 1;     ///< n >= 1
    int first_lag = 0;
    int last_lag = 0;      ///< >= max(first_lag, 0)
    bool partial = false;  ///< the other inputs are held
  };

  /// `length` as of `RankWindow`, samples. Throws std::invalid_argument on an impossible shape.
  RankCorrelation(const Shape& shape, int length);

  /// Takes u(k) (m values) and e(k) (n values), all finite, of the next interval.
  void update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& residuals);
  /// The intervals so far and the next one are not neighbours: no row may span both.
  void close_window() { filled_ = 0; }

  /// Refreshes all correlations.
  void evaluate();
  /// Of one channel, for lags first_lag..last_lag, after `evaluate`: -1..1; 0 where a signal does
  /// not move, or an input not by itself.
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> correlations(int cv, int input) const {
    return correlations_.col(input * shape_.cvs + cv);
  }
  [[nodiscard]] int lag_count() const { return shape_.last_lag - shape_.first_lag + 1; }

  void archive(Archive& a);

 private:
  void hold_others(int input);
  [[nodiscard]] double beside_others(int signal);

  Shape shape_;
  int window_rows_;  // intervals a row spans
  int filled_ = 0;   // neighbouring intervals so far, at most window_rows_
  std::vector<LagWindow> input_windows_;
  std::vector<LagWindow> residual_windows_;
  RankWindow window_;  // the inputs, then of each CV its lags
  Eigen::VectorXd row_;
  Eigen::MatrixXd correlations_;  // lags x (inputs * cvs)
  Eigen::MatrixXd coefficients_;  // of each input (rows) with every signal of the window
  Eigen::MatrixXd factor_;        // Cholesky's, of the inputs held and then of one
  std::vector<int> order_;
  Eigen::VectorXd left_;
};

}  // namespace mpm
