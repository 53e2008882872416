#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/mismatch/channel_evaluator.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/curvature.hpp"
#include "core/mismatch/older_movement.hpp"
#include "core/mismatch/outside_signals.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/residual_regression.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {

class Archive;

/// A signal that a CV follows, beside errors of the CV's channels as the cause of what is off.
struct RivalSignal {
  int signal = -1;    ///< -1: none, or one that nobody logs
  bool wins = false;  ///< it clearly explains more
  bool loses = true;  ///< it clearly explains less

  template <class Archive>
  void archive(Archive& a) {
    a(signal, wins, loses);
  }
};

/// Finds the channels of which the model is wrong. Per CV j the model residual e_j is regressed, in
/// ARX form (the direct method, valid in closed loop because the innovation w_j(k) is independent
/// of the past), on the rows of `RegressionHistory`, and F tests that input i's block of
/// coefficients is zero given all the others, which is so exactly where channel (j, i) matches
/// (Ljung 1999, section 13.4, for the regression; Seber and Lee 2003, section 4.3, for F;
/// `ChannelEvaluator` for what is read off), and so do those of other CVs on whose residuals e_j
/// rests: where one of these may be wrong they are judged together (`CoupledErrors`). Rows are
/// weighted
///
///     lambda^age * min(1, 3 s / |r|)^2 / s^2,
///
/// r the row's one-step prediction error and s its running s.d. (`NoiseLevel`), so that a change of
/// the noise level or heavy tails do not raise the false-alarm rate.
///
/// Several memories run side by side on the same rows: a long one that sees small errors, a short
/// one that sees sudden ones sooner. A CV can be started afresh from any sample that is still
/// remembered. No allocation after construction but where curvature is looked for.
class MismatchDetector {
 public:
  /// `memories`: the first one is the longest; its prediction errors weigh the rows.
  /// `remembered`: samples from which a CV can start afresh. `patience`: samples (>= 1) after which
  /// rows that wait are taken at the latest.
  MismatchDetector(const RegressionShape& shape, const std::vector<MemoryLength>& memories,
                   int remembered, int patience, const LinearModel& model,
                   std::vector<MaterialityLimits> limits = {{}});

  /// Takes u(k) and e(k) of the next interval, NaN where unknown.
  void update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
              const Eigen::Ref<const Eigen::VectorXd>& residuals);
  /// `missing` intervals (>= 1) of which nothing is known.
  void skip(std::int64_t missing);
  /// Whether the last sample gave this CV a row.
  [[nodiscard]] bool took_row(int cv) const { return history_.usable(cv); }

  /// Takes the rows of a CV that wait; before, nothing else that is asked here knows of them.
  void fold(int cv);
  /// Folds, and refreshes the evidence of one CV in one memory, which is ready.
  void evaluate(int cv, int memory = 0);
  /// Of the last `evaluate`.
  [[nodiscard]] const ChannelEvidence& evidence(int cv, int input, int memory = 0) const {
    return evidence_[first_evidence(cv, memory) + static_cast<std::size_t>(input)];
  }
  /// The usual errors of the CV's channels, for `OutsideSignals`: `JointErrors::errors`, of the
  /// first memory, which is ready. Valid until the next evaluation.
  [[nodiscard]] const Eigen::MatrixXd& usual_errors(int cv);
  /// What a signal that is no input says of a CV beside errors of its channels. After
  /// `evaluate(cv, 0)`.
  [[nodiscard]] RivalSignal rival(int cv, const FollowedSignal& followed) const;
  /// Whether the inputs go with what is off in a CV, but errors of its channels explain little of
  /// that. After `evaluate(cv, 0)`.
  [[nodiscard]] bool unlike_errors(int cv) const;
  /// Forgets of this CV what is older than its last `samples` samples (>= 0).
  void start_afresh(int cv, int samples);

  /// Looks whether the CV's answer depends on where the plant is operated. Where that is certain,
  /// and explains more than `least` residual variances, its regression takes the terms in, and
  /// true. From then on errors are those of the linear part alone, and what is small beside the
  /// gain's variation does not matter. Allocates.
  bool take_in_curvature(int cv, double least);
  /// Of a CV of which that was found; null of others.
  [[nodiscard]] const Curvature* curvature(int cv) const {
    const std::optional<Curvature>& found = curvatures_[static_cast<std::size_t>(cv)];
    return found ? &*found : nullptr;
  }

  [[nodiscard]] const ResidualRegression& regression(int cv) const {
    return regressions_[static_cast<std::size_t>(cv)];
  }
  [[nodiscard]] const RegressionMemory& memory(int cv, int memory = 0) const {
    return regression(cv).memory(memory);
  }
  [[nodiscard]] int memory_count() const { return memory_count_; }
  [[nodiscard]] const RegressionShape& shape() const { return shape_; }
  [[nodiscard]] const RegressionHistory& history() const { return history_; }

  void archive(Archive& a);

 private:
  void forget_older(int cv);
  [[nodiscard]] std::size_t first_evidence(int cv, int memory) const {
    return static_cast<std::size_t>((memory * shape_.cvs + cv) * shape_.inputs);
  }

  RegressionShape shape_;
  int memory_count_;
  LinearModel model_;
  RegressionHistory history_;
  OlderMovement older_;
  int forgetful_;                                     // the next CV to forget it; cvs: none
  std::vector<ResidualRegression> regressions_;       // per CV
  std::vector<std::optional<Curvature>> curvatures_;  // per CV
  RowWorkspace work_;
  ChannelEvaluator evaluator_;
  std::vector<ChannelEvidence> evidence_, again_;
  std::vector<ChannelEvaluator::Explained> explained_;  // per CV, of the first memory
  std::vector<int> doubted_;  // per memory and CV: by itself it has a channel that may be wrong
  std::vector<const RegressionMemory*> beside_;  // per CV, those that are ready
};

}  // namespace mpm
