#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/model/linear_model.hpp"
#include "core/monitor/feedback_correction.hpp"
#include "core/monitor/model_agreement.hpp"
#include "core/monitor/unit_inputs.hpp"
#include "core/signal/frame.hpp"
#include "core/signal/screen.hpp"

namespace mpm {

/// Whether the model has a channel, per channel, input-major: whether it moves the CV within
/// `length` samples.
[[nodiscard]] std::vector<bool> channels_of(const LinearModel& model, int length);

/// Whether some CV's prediction is simulated from the first sample on and for good.
[[nodiscard]] bool simulates_some(const std::vector<bool>& may_predict);

/// Each CV's prediction: what comes with the frames or, where none does (`Screen::predicted`) or
/// what comes is corrected by the measurement (`FeedbackCorrection`), what the model makes of the
/// inputs. No allocation after construction.
class Predictions {
 public:
  /// `may_predict[j]`: CV j's may come with the frames; `acts`: see `channels_of`;
  /// Samples until the model can be trusted: `starting_samples` after the first one,
  /// `settling_samples` after an input has moved unseen. An input is lost when it has been unknown
  /// for more than `lost_samples`.
  Predictions(const LinearModel& model, const std::vector<bool>& may_predict,
              const std::vector<bool>& acts, int starting_samples, int settling_samples,
              int lost_samples);

  /// Comes with the frames.
  [[nodiscard]] bool given(int cv) const { return given_[static_cast<std::size_t>(cv)]; }
  /// Comes, and is corrected by the measurement: it is simulated instead.
  [[nodiscard]] bool corrected(int cv) const {
    return corrections_[static_cast<std::size_t>(cv)].corrected();
  }
  /// Comes, and is not what the model makes of the inputs.
  [[nodiscard]] bool of_other_model(int cv) const {
    return given(cv) && agreements_[static_cast<std::size_t>(cv)].differs();
  }
  /// Comes from elsewhere than it did, or is simulated, and cannot be trusted yet.
  [[nodiscard]] bool settling(int cv) const { return settling_[static_cast<std::size_t>(cv)] > 0; }
  /// An input that acts on it was lost, and what it did meanwhile may still show.
  [[nodiscard]] bool unseen(int cv) const { return unseen_[static_cast<std::size_t>(cv)] > 0; }
  /// Of the CV at this frame; NaN where it is not known.
  [[nodiscard]] double predicted(int cv, const Frame& frame) const;

  /// Where they have begun or ceased to come with the screen's frames: `turns(cv)`, of which all
  /// statistics are to begin anew.
  template <class Turns>
  void follow(const Screen& screen, Turns turns);
  /// Before the residuals of a frame are read. What disturbs in the model keeps to the clock of the
  /// data, over gaps too. An input that was unknown for long moved unseen: what is simulated from
  /// it is wrong until it has forgotten that; and what it did through an error of its channel goes
  /// with the inputs that moved with it, whoever predicted.
  void begin(const Frame& frame, const UnitInputs& inputs);
  /// After they were read: the frame's part, then the inputs' part.
  void compare(const Frame& frame);
  void advance(const UnitInputs& inputs);
  /// `missing` intervals of which nothing is known.
  void skip(std::int64_t missing, const UnitInputs& inputs);

  template <class Archive>
  void archive(Archive& a) {
    // not archived: may_predict_, acts_, has_model_, integrating_, starting_samples_,
    // settling_samples_, lost_samples_ (construction)
    a(model_, started_, given_, corrections_, agreements_, settling_, unseen_, simulation_settles_);
  }

 private:
  void distrust(int input, std::int64_t unknown_run);
  void turn(std::size_t cv);

  LinearModel model_;
  std::vector<bool> may_predict_;
  std::vector<bool> acts_;
  bool has_model_;
  std::vector<bool> integrating_;  // per CV
  int starting_samples_, settling_samples_, lost_samples_;
  bool started_ = false;  // the simulation
  std::vector<bool> given_;
  std::vector<FeedbackCorrection> corrections_;
  std::vector<ModelAgreement> agreements_;
  std::vector<std::int64_t> settling_;   // samples until a simulated one can be trusted
  std::vector<std::int64_t> unseen_;     // samples until what moved unseen has settled
  std::int64_t simulation_settles_ = 0;  // likewise, of all CVs, whether they are used or not
};

template <class Turns>
void Predictions::follow(const Screen& screen, Turns turns) {
  for (std::size_t j = 0; j < given_.size(); ++j) {
    const int cv = static_cast<int>(j);
    // Without any model only the control system can predict.
    const bool given =
        has_model_ ? screen.predicted(cv) && !corrected(cv) : screen.predicted(cv) || given_[j];
    if (given != given_[j]) {
      turn(j);
      turns(cv);
    }
  }
}

}  // namespace mpm
