#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/model/linear_model.hpp"
#include "core/monitor/cv_reading.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/predictions.hpp"
#include "core/monitor/unit_inputs.hpp"
#include "core/monitor/unit_residuals.hpp"
#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

class Archive;

/// What the samples of a unit say before anything is judged: frames in, screened inputs,
/// predictions and residuals out, sample by sample and over gaps. No allocation after construction.
class UnitReader {
 public:
  /// `may_predict[j]`: CV j's model prediction may come with the frames.
  UnitReader(const LinearModel& model, const SignalCounts& counts,
             const std::vector<bool>& may_predict, const DerivedSettings& settings);

  /// Frames come in increasing interval order; a jump is a gap.
  void push(const Frame& frame) { screen_.push(frame); }
  /// With the last frame it turned out that all is to begin anew (`Screen::anew`).
  [[nodiscard]] bool anew() const { return screen_.anew(); }
  /// After construction: takes over the screen of another reader of the same unit, with its frames
  /// and what it has learnt.
  void begin_with(Screen&& screen) { screen_ = std::move(screen); }

  /// The next frame that has left the screen, once it is read: what follows is as of it. Null where
  /// there is none; valid until the next call.
  [[nodiscard]] const Frame* next();
  /// Intervals missing before that frame.
  [[nodiscard]] std::int64_t missing() const { return missing_; }
  /// CVs whose predictions come with the frames from this one on, or do no longer.
  [[nodiscard]] const std::vector<int>& turned() const { return turned_; }
  /// Frames read since all began, or began anew.
  [[nodiscard]] std::int64_t samples() const { return samples_; }
  /// What its CVs read; `judged` has room for them.
  void tell(const Frame& frame, JudgedFrame& judged) const;

  /// `Screen::read_seldom`.
  void read_seldom(int cv, bool seldom) { screen_.read_seldom(cv, seldom); }

  [[nodiscard]] const Screen& screen() const { return screen_; }
  [[nodiscard]] Screen&& give_screen() { return std::move(screen_); }
  [[nodiscard]] const UnitInputs& inputs() const { return inputs_; }
  [[nodiscard]] const Predictions& predictions() const { return predictions_; }
  [[nodiscard]] const UnitResiduals& residuals() const { return residuals_; }
  /// Of the CVs at that frame, measured or not; NaN where it is not known.
  [[nodiscard]] const Eigen::VectorXd& predicted() const { return predicted_; }

  void archive(Archive& a);

 private:
  UnitReader(const LinearModel& model, const SignalCounts& counts,
             const std::vector<bool>& may_predict, const DerivedSettings& settings,
             const std::vector<bool>& acts);

  Screen screen_;
  UnitInputs inputs_;
  Predictions predictions_;
  UnitResiduals residuals_;
  Eigen::VectorXd predicted_;
  std::int64_t samples_ = 0, interval_ = 0;  // read; of the last one
  std::int64_t missing_ = 0;
  std::vector<int> turned_;
};

}  // namespace mpm
