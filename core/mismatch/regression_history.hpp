#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/signal/lag_window.hpp"

namespace mpm {

class Archive;

/// What the residual of a CV is regressed on: a constant, the last `residual_order` residuals of
/// all CVs, beyond them one exponentially weighted mean of its own per residual pole, what a wrong
/// start may leave behind (a decay per start pole), and per input a block: its last `fir_lags`
/// values and, beyond them, one exponentially weighted mean per tail pole.
///
/// The means are for noise that remembers longer than the lags, as a walk under measurement noise
/// does (Muth 1960): it passes for what slow inputs do otherwise, and draws gains that are wrong
/// towards the model's.
struct RegressionShape {
  int inputs = 1;
  int cvs = 1;
  int fir_lags = 1;                ///< L >= 1
  int residual_order = 1;          ///< p >= 1
  std::vector<double> tail_poles;  ///< r_t in (0, 1); at least one
  std::vector<double> start_poles = {};
  int terms = 0;  ///< columns of Volterra terms behind the lead-in, of a CV that has some
  std::vector<double> residual_poles = {};  ///< q_t in (0, 1)
  bool bounded = true;  ///< no row decides a direction where tails are heavy (`NoiseLevel`)

  [[nodiscard]] int block() const { return fir_lags + static_cast<int>(tail_poles.size()); }
  /// Columns of a CV's own past.
  [[nodiscard]] int past() const { return residual_order + means(); }
  [[nodiscard]] int means() const { return static_cast<int>(residual_poles.size()); }
  /// Where the lags of a CV begin, and the means.
  [[nodiscard]] int lags_of(int cv) const { return 1 + cv * residual_order; }
  [[nodiscard]] int means_at() const { return lags_of(cvs); }
  [[nodiscard]] int lead_in() const {
    return means_at() + means() + static_cast<int>(start_poles.size()) + terms;
  }
  [[nodiscard]] int columns() const { return lead_in() + inputs * block(); }
  /// A CV's own of the regression's coefficients: of its lags, then of its means.
  void own_past(int cv, const Eigen::VectorXd& coefficients, Eigen::VectorXd& past) const {
    past.head(residual_order) = coefficients.segment(lags_of(cv), residual_order);
    past.tail(means()) = coefficients.segment(means_at(), means());
  }
};

/// The last samples of a unit and the regression rows that they make:
///
///     1,  e_1..e_n (k-1 .. k-p),  of the CV's own m_jt(k-p-1), t = 1..means,
///     r_s^k, s = 1..starts, until all is forgotten,
///     and per input i:  u_i(k-1 .. k-L), s_it(k-L-1), t = 1..tails,
///     s_it(k) = r_t s_it(k-1) + (1 - r_t) u_i(k),  m_jt likewise of e_j with q_t.
///
/// Unknown values (NaN) do not break the window. An unknown input counts as unchanged: where its
/// channel is right e does not depend on it. Where it is not, what it does goes with the inputs
/// that move with it, so that whoever pushes takes a CV for unknown while an input of it is lost
/// (`Predictions::unseen`). A residual that is
/// unknown once or twice in a row is interpolated when the next one comes; longer gaps are not.
/// A CV's row counts (`usable`) where its response and the one before are known, and none of its
/// own lags lies in a long gap: the residual just before has a large coefficient, and what is
/// guessed there would correlate with the inputs through the controller's feedback. The means of a
/// residual begin with its first value, and again with the first one after a long gap.
///
/// No allocation after construction.
class RegressionHistory {
 public:
  /// Remembers `depth` rows.
  RegressionHistory(const RegressionShape& shape, int depth);

  /// Takes u(k) and e(k) of the next interval; NaN where unknown.
  void push(const Eigen::Ref<const Eigen::VectorXd>& inputs,
            const Eigen::Ref<const Eigen::VectorXd>& residuals);
  /// `missing` intervals (>= 1) of which nothing is known.
  void skip(std::int64_t missing);

  [[nodiscard]] int depth() const { return depth_; }
  [[nodiscard]] int inputs() const { return shape_.inputs; }
  /// Rows, at most `depth`, in which nothing is left of what the start left behind.
  [[nodiscard]] int settled() const { return settled_; }
  /// Whether the newest row serves this CV.
  [[nodiscard]] bool usable(int cv) const { return usable_[static_cast<std::size_t>(cv)]; }
  /// A CV's row whose response is `age` samples old, 0 <= age < depth: columns() values.
  void fill(int cv, int age, double* row) const;
  /// The same in two parts: what comes before the inputs' blocks, and these, which are no CV's own.
  void fill_lead_in(int cv, int age, double* row) const;
  void fill_inputs(int age, double* row) const;
  /// Of the sample `age` samples ago, in its own units; unknown ones as unchanged.
  [[nodiscard]] double input(int input, int age) const {
    return origin_(input) + input_windows_[static_cast<std::size_t>(input)].window()[age];
  }
  [[nodiscard]] double residual(int cv, int age) const {
    return residual_windows_[static_cast<std::size_t>(cv)].window()[age];
  }

  void archive(Archive& a);

 private:
  void push_inputs(const Eigen::Ref<const Eigen::VectorXd>& inputs);
  void push_starts();
  void push_residual(int cv, double residual);
  void follow_means(int cv, int from, bool begin);

  RegressionShape shape_;
  int depth_;
  int settled_ = 0;
  int filled_ = 0;                // intervals so far, until a row has all its lags
  std::vector<bool> has_origin_;  // per input
  Eigen::VectorXd origin_;        // first known value: keeps the windows' values small
  Eigen::VectorXd last_input_;    // about the origin
  Eigen::VectorXd unknown_;       // all NaN
  std::vector<LagWindow> input_windows_;
  std::vector<LagWindow> tail_windows_;  // input-major
  std::vector<LagWindow> residual_windows_;
  std::vector<LagWindow> mean_windows_;  // of the residuals, CV-major
  std::vector<LagWindow> start_windows_;
  std::vector<int> unknown_run_;  // per CV, unknown residuals up to now
  std::vector<int> since_gap_;    // per CV, samples since the last long gap
  std::vector<bool> has_mean_;    // per CV
  std::vector<bool> usable_;
};

}  // namespace mpm
