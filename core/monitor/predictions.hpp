#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/linear_model.hpp"
#include "core/monitor/unit_inputs.hpp"
#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

/// Whether the model has a channel, per channel, input-major: whether it moves the CV within
/// `length` samples.
[[nodiscard]] std::vector<bool> channels_of(const LinearModel& model, int length);

/// Whether some CV's prediction is simulated from the first sample on and for good.
[[nodiscard]] bool simulates_some(const std::vector<bool>& may_predict);

/// Each CV's prediction: what comes with the frames or, where none does (`Screen::predicted`), what
/// the model makes of the inputs. Where the control system says what its model predicts, no
/// simulation is asked. No allocation after construction.
class Predictions {
 public:
  /// `may_predict[j]`: CV j's may come with the frames; `acts`: see `channels_of`;
  /// Samples until the model can be trusted: `starting_samples` after the first one,
  /// `settling_samples` after an input has moved unseen.
  Predictions(const LinearModel& model, const std::vector<bool>& may_predict,
              const std::vector<bool>& acts, int starting_samples, int settling_samples);

  /// Some CV's is simulated.
  [[nodiscard]] bool simulates() const { return simulates_; }
  /// Comes with the frames.
  [[nodiscard]] bool given(int cv) const { return given_[static_cast<std::size_t>(cv)]; }
  /// Comes from elsewhere than it did, or is simulated, and cannot be trusted yet.
  [[nodiscard]] bool settling(int cv) const { return settling_[static_cast<std::size_t>(cv)] > 0; }
  /// Measured minus predicted; NaN where the prediction is not known, or the measurement is not.
  [[nodiscard]] double residual(int cv, const Frame& frame) const;

  /// Where they have begun or ceased to come with the screen's frames: `turns(cv)`, of which all
  /// statistics are to begin anew.
  template <class Turns>
  void follow(const Screen& screen, Turns turns);
  /// Before the residuals of a frame are read. What disturbs in the model keeps to the clock of the
  /// data, over gaps too. An input that was unknown for long moved unseen: what is simulated from
  /// it is wrong until it has forgotten that.
  void begin(const Frame& frame, const UnitInputs& inputs);
  /// After they were read.
  void advance(const UnitInputs& inputs);
  /// `missing` intervals of which nothing is known.
  void skip(std::int64_t missing, const UnitInputs& inputs);

  template <class Archive>
  void archive(Archive& a) {
    // not archived: may_predict_, acts_, has_model_, starting_samples_, settling_samples_
    // (construction)
    a(model_, simulates_, started_, given_, settling_);
  }

 private:
  void distrust(int input);
  void turn(std::size_t cv);

  LinearModel model_;
  std::vector<bool> may_predict_;
  std::vector<bool> acts_;
  bool has_model_;
  int starting_samples_, settling_samples_;
  bool simulates_ = true;
  bool started_ = false;
  std::vector<bool> given_;
  std::vector<std::int64_t> settling_;  // samples until a simulated one can be trusted
};

template <class Turns>
void Predictions::follow(const Screen& screen, Turns turns) {
  simulates_ = false;
  for (std::size_t j = 0; j < given_.size(); ++j) {
    const int cv = static_cast<int>(j);
    // Without any model only the control system can predict.
    const bool given = screen.predicted(cv) || (given_[j] && !has_model_);
    if (given != given_[j]) {
      turn(j);
      turns(cv);
    }
    simulates_ = simulates_ || (!given_[j] && (has_model_ || !may_predict_[j]));
  }
  started_ = started_ && simulates_;
}

}  // namespace mpm
