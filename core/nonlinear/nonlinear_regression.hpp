#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/regression_memory.hpp"
#include "core/mismatch/residual_regression.hpp"
#include "core/nonlinear/linear_companions.hpp"
#include "core/nonlinear/nonlinear_terms.hpp"
#include "core/nonlinear/term_selection.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

class Archive;

/// A static curve in front of a channel, beside the straight line that a linear channel makes of
/// it.
struct CurvePoint {
  double input = 0.0;  ///< MV units
  double bend = 0.0;   ///< what the channel's dynamics see beyond it, MV units
  double sd = 0.0;     ///< of the bend
};

/// One CV's residual regressed on the rows of the linear test with the CV's nonlinear terms behind
/// them, weighed as they are there (`ResidualRegression`), and F tests of the groups of terms
/// (Seber and Lee 2003, section 4.3). The linear columns come first and stay: what they explain,
/// rightly or by chance, is never called nonlinear. The residual's own past among them takes
/// coloured noise off, so the test holds in closed loop as the linear one does.
///
/// One explanation comes after the other (forward selection, Miller 2002, section 3.3): of the
/// groups that are significant and matter, the one that explains most for its columns (Schwarz
/// 1978) is taken in, its inputs are to blame, and so that what it leaves over is not blamed on
/// others, all that these inputs could do by themselves and together is taken in with it, and so is
/// a curve of all inputs together, which blames a CV only where it is the first to. Another
/// input is to blame only for what is left then, and only where that is no small part of what was
/// explained: few terms follow a bend to the end.
///
/// It begins, with all that is remembered, once the linear regression has rows enough, and anew
/// where that one does or has twice as many rows, until the memory is full: the inputs are then
/// known better. No allocation but where it begins.
class NonlinearRegression {
 public:
  /// `patience`: samples (>= 1) after which `take` is called at the latest.
  NonlinearRegression(const RegressionShape& shape, int cv, const LinearModel& model,
                      NonlinearTest test, const MemoryLength& memory, int patience);

  /// After the history took a sample.
  void add_sample(const RegressionHistory& history);
  /// After it skipped `missing` (>= 1) samples, before which all rows were taken.
  void add_gap(int missing, const RegressionHistory& history);
  /// Takes the rows that wait. After the CV's linear regression took them.
  void take(const RegressionHistory& history, const ResidualRegression& regression);

  /// Whether there are rows enough for p-values to mean anything.
  [[nodiscard]] bool ready() const;
  /// Reads the factor; it is ready. `results`: one per input, but for the verdict; `material` says
  /// that the input is to blame. `rate`: p-value of a channel below which it may be. `variation`:
  /// two s.d. of the local gain that would be of interest, relative to the model's.
  void evaluate(double rate, double variation, ChannelNonlinearity* results);
  /// Of the last `evaluate`: the group of the input's curve alone beside what is linear, from two
  /// s.d. below the input's mean to two above it. Allocates.
  [[nodiscard]] std::vector<CurvePoint> input_curve(int input) const;
  [[nodiscard]] const RegressionMemory& memory() const { return memory_; }
  [[nodiscard]] const NonlinearTerms& terms() const { return terms_; }

  void archive(Archive& a);

 private:
  void begin(const RegressionHistory& history, const ResidualRegression& regression);
  void feed(const RegressionHistory& history, const ResidualRegression& regression, int age,
            int term_age);
  void flush();
  void advance(const RegressionHistory& history, int age);
  /// Columns of the residuals' past.
  [[nodiscard]] int past() const { return shape_.cvs * shape_.residual_order + shape_.means(); }
  [[nodiscard]] int linear_columns() const {
    return shape_.columns() - past() + companions_.columns();
  }
  /// What the residuals' past is taken to say: what it does where the terms are left out, or beside
  /// them.
  enum class Past { kWithoutTerms, kBesideTerms };
  void read(Past past);
  void without_terms();
  /// What a group of terms says beside those taken in.
  struct Explanation {
    int group = -1;
    TermSelection::Gain gain;
  };
  [[nodiscard]] Explanation best_explanation(double rate, ChannelNonlinearity* results);
  void look_at(int group, const TermSelection::Gain& gain, ChannelNonlinearity* results) const;
  void blame(const Explanation& best, ChannelNonlinearity* results);
  void take(int group, ChannelNonlinearity* results);
  [[nodiscard]] bool all_blamed(int group) const;
  [[nodiscard]] bool matters(const TermSelection::Gain& gain) const;
  [[nodiscard]] int groups_with(int input) const;
  void see(double variation, ChannelNonlinearity* results) const;
  [[nodiscard]] int past_at() const { return linear_columns() + terms_.columns(); }
  [[nodiscard]] double chance(const TermSelection::Gain& gain) const;
  [[nodiscard]] double chance(int group, const TermSelection::Gain& gain) const;

  RegressionShape shape_;
  int cv_;
  LinearCompanions companions_;
  NonlinearTerms terms_;
  RegressionMemory memory_;
  RowBatch batch_;
  std::vector<double> shares_;  // of the rows in it
  int batched_ = 0;
  int patience_;
  int waiting_ = 0;
  bool begun_ = false;
  int rows_at_begin_ = 0;
  std::uint64_t restarts_ = 0;  // of the linear regression when this one began
  TermSelection selection_;
  std::vector<double> chances_;  // per group, of the past without terms
  std::vector<bool> taken_;      // per group
  std::vector<bool> blamed_;     // per input
  double bend_square_ = 0.0;     // what the groups taken in explain
  std::vector<double> lead_in_;
  GivensQr past_factor_;
  Eigen::VectorXd coefficients_;
  Eigen::VectorXd taken_off_, own_past_;
  Eigen::VectorXd rotated_;  // of the terms
  double own_gain_ = 1.0;
  double error_variance_ = 0.0;  // of a coefficient with a covariance factor of norm 1
  double freedom_ = 0.0;
  double linear_square_ = 0.0;  // what the inputs' linear columns explain
};

}  // namespace mpm
