#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mismatch/residual_regression.hpp"
#include "core/regression/row_feed.hpp"
#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// What a CV's residual follows that is no input of the model.
struct FollowedSignal {
  int signal = -1;         ///< -1: none
  double explained = 0.0;  ///< of the weighted residual square, beyond its own past
  double beside = 0.0;     ///< likewise, beyond usual errors of the CV's channels as well
  int numbers = 0;         ///< that the signal does it with
};

/// Signals that are measured but no inputs of the model (set-points, auxiliary ones), and how well
/// each by itself explains a CV's residual: a regression on the constant, the last residuals of all
/// CVs and the signal's value and exponentially weighted means of it (`poles`), with the rows and
/// weights of the CV's own regression. Signals that read an input back (`reads_back`) are none.
/// Allocates when it asks a signal that; of one that is none again when there are twice the rows,
/// for an input may stand still at first.
class OutsideSignals {
 public:
  /// `depth`: samples remembered.
  OutsideSignals(const RegressionShape& shape, int signals, std::vector<double> poles, int depth);

  /// Takes the signals' values at k, NaN where unknown: unchanged.
  void push(const Eigen::Ref<const Eigen::VectorXd>& values);
  void skip(std::int64_t missing);

  /// The signal that explains most of the CV's residual over the rows of its first memory.
  /// `usual`: the usual errors of its channels (`JointErrors::errors`).
  [[nodiscard]] FollowedSignal followed(int cv, const RegressionHistory& history,
                                        const ResidualRegression& regression,
                                        const Eigen::MatrixXd& usual);

  void archive(Archive& a);

 private:
  [[nodiscard]] int block() const { return static_cast<int>(poles_.size()) + 1; }
  [[nodiscard]] bool reads_an_input_back(int signal, const RegressionHistory& history, int span);
  void fill_errors(const Eigen::MatrixXd& usual, const RegressionHistory& history, int age,
                   double* row);
  [[nodiscard]] double explained_by(int signal, int cv, const RegressionHistory& history,
                                    const ResidualRegression& regression,
                                    const Eigen::MatrixXd* beside);

  RegressionShape shape_;
  int signals_;
  int depth_;
  std::vector<double> poles_;
  std::vector<double> origin_, last_;
  // Per signal: whether it reads an input back, and the span of rows that said so.
  struct Readback {
    bool is = false;
    int asked_span = 0;
    template <class Archive>
    void archive(Archive& a) {
      a(is, asked_span);
    }
  };
  std::vector<Readback> readbacks_;
  std::vector<LagWindow> windows_;  // signal-major: value, means
  Eigen::VectorXd unknown_;         // all NaN
  std::vector<double> inputs_;      // of one row
  RowFeed feed_;
  GivensQr alone_, beside_;  // [lead-in | signal], [lead-in | usual errors | signal]
};

}  // namespace mpm
