#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/channel_evaluator.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/model/linear_model.hpp"
#include "core/regression/row_batch.hpp"

namespace mpm {

/// How long a memory is: rows fade with `lambda` per row, or, where `window` > 0, the last `window`
/// samples count alike and older ones not at all.
struct MemoryLength {
  double lambda = 1.0;  ///< 0 < lambda <= 1; 1 in a sliding window
  int window = 0;       ///< samples
};

/// Finds the channels of which the model is wrong. Per CV j the model residual e_j is regressed, in
/// ARX form (the direct method, valid in closed loop because the innovation w_j(k) is independent
/// of the past), on the rows of `RegressionHistory`, and F tests that input i's block of
/// coefficients is zero given all the others, which is so exactly where channel (j, i) matches
/// (Ljung 1999, section 13.4, for the regression; Seber and Lee 2003, section 4.3, for F;
/// `ChannelEvaluator` for what is read off). Rows are weighted
///
///     lambda^age * min(1, 3 s / |r|)^2 / s^2,
///
/// r the row's one-step prediction error and s its running s.d., so that a change of the noise
/// level or heavy tails do not raise the false-alarm rate.
///
/// Several memories run side by side on the same rows: a long one that sees small errors, a short
/// one that sees sudden ones sooner. A CV can be started afresh from any sample that is still
/// remembered.
///
/// Once a CV has had enough rows, new ones wait for each other and are taken together (`fold`),
/// which loads a factor once for all of them. The prediction that weighs a row is that of the rows
/// before the first one that waits with it.
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
  [[nodiscard]] const ChannelEvidence& evidence(int cv, int input, int memory = 0) const {
    return evidence_[at(cv, memory) * static_cast<std::size_t>(shape_.inputs) +
                     static_cast<std::size_t>(input)];
  }
  [[nodiscard]] const RegressionMemory& memory(int cv, int memory = 0) const {
    return memories_[at(cv, memory)];
  }
  [[nodiscard]] int memory_count() const { return static_cast<int>(lengths_.size()); }

  /// Forgets of this CV what is older than its last `samples` samples (>= 0).
  void start_afresh(int cv, int samples);
  /// Mean square of the one-step errors over the last 100 rows against that over the last 2000:
  /// well above 1 where the noise rose or the channels changed.
  [[nodiscard]] double surprise(int cv) const {
    const Response& response = responses_[index(cv)];
    return response.lasting_square > 0.0 ? response.recent_square / response.lasting_square : 1.0;
  }
  /// Samples of this CV that its memories may rest on, at most `remembered`.
  [[nodiscard]] int span(int cv) const { return responses_[index(cv)].span; }

  [[nodiscard]] const RegressionShape& shape() const { return shape_; }
  [[nodiscard]] const RegressionHistory& history() const { return history_; }
  /// Weight that multiplies the row of age `age`, 0 where there is none; 1 / CV units.
  [[nodiscard]] double row_weight(int cv, int age) const {
    return weight_windows_[index(cv)].window()[age];
  }
  /// The same with rows clipped at 6 instead of 3 s.d.: after a change many rows surprise, and they
  /// are what tells of it.
  [[nodiscard]] double lenient_weight(int cv, int age) const {
    constexpr double kLenience =
        calibration::row_weights::kLenientClip / calibration::row_weights::kClip;
    return std::min(kLenience * row_weight(cv, age), 1.0 / scale_windows_[index(cv)].window()[age]);
  }

 private:
  struct Response {
    double scale = 1.0;       // running s.d. of the one-step error, CV units
    double scale_rows = 0.0;  // rows it rests on
    bool scaled = false;
    int span = 0;
    double recent_square = 0.0;   // mean square of the clipped errors, CV units, over 100 rows
    double lasting_square = 0.0;  // over 2000
    double square_rows = 0.0;
    double clipped_share = 0.0;  // of the rows, over 2000
    int waiting = 0;             // samples since the last fold
  };
  [[nodiscard]] std::size_t index(int cv) const { return static_cast<std::size_t>(cv); }
  [[nodiscard]] std::size_t at(int cv, int memory) const {
    return static_cast<std::size_t>(memory * shape_.cvs + cv);
  }
  [[nodiscard]] int patience(int cv) const;
  void take(int cv, int oldest, int newest);
  double weigh(int cv, const GivensQr::Preview& preview, bool together);
  void begin_scale(int cv);
  void slide(int cv, int memory);
  void refill(int cv, int memory, int samples);

  RegressionShape shape_;
  std::vector<MemoryLength> lengths_;
  int remembered_;
  RegressionHistory history_;
  ChannelEvaluator evaluator_;
  std::vector<Response> responses_;
  std::vector<LagWindow> weight_windows_;   // per CV and row: 1 / scale, times the clip; 0 = no
                                            // row, < 0: it waits
  std::vector<LagWindow> scale_windows_;    // per CV and row: `Response::scale` before it
  std::vector<RegressionMemory> memories_;  // memory-major
  std::vector<int> slides_;                 // per memory: samples until its window is rebuilt
  std::vector<ChannelEvidence> evidence_;
  RowBatch rows_;     // as they are
  RowBatch weighed_;  // consumed by the factors
  std::vector<int> ages_;
  std::vector<GivensQr::Preview> previews_;
};

}  // namespace mpm
