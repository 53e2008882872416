#include "core/monitor/predictions.hpp"

#include <algorithm>
#include <limits>

#include "core/monitor/calibration.hpp"

namespace mpm {

using calibration::bad_data::kHeldSamples;

namespace {

std::vector<bool> integrating_cvs(const LinearModel& model) {
  std::vector<bool> integrating;
  for (int j = 0; j < model.cv_count(); ++j)
    integrating.push_back(model.integrating().row(j).any());
  return integrating;
}

}  // namespace

std::vector<bool> channels_of(const LinearModel& model, int length) {
  std::vector<bool> acts;
  for (int i = 0; i < model.input_count(); ++i)
    for (int j = 0; j < model.cv_count(); ++j)
      acts.push_back(model.impulse_response(j, i, length).cwiseAbs().maxCoeff() > 0.0);
  return acts;
}

bool simulates_some(const std::vector<bool>& may_predict) {
  return std::find(may_predict.begin(), may_predict.end(), false) != may_predict.end();
}

Predictions::Predictions(const LinearModel& model, const std::vector<bool>& may_predict,
                         const std::vector<bool>& acts, int starting_samples, int settling_samples,
                         int lost_samples)
    : model_(model),
      may_predict_(may_predict),
      acts_(acts),
      has_model_(std::find(acts.begin(), acts.end(), true) != acts.end()),
      integrating_(integrating_cvs(model)),
      starting_samples_(starting_samples),
      settling_samples_(settling_samples),
      lost_samples_(lost_samples),
      given_(may_predict.size(), false),
      corrections_(may_predict.size()),
      agreements_(may_predict.size()),
      settling_(may_predict.size(), 0),
      unseen_(may_predict.size(), 0) {}

double Predictions::predicted(int cv, const Frame& frame) const {
  const SignalBlock& predicted = frame[SignalKind::kPrediction];
  if (given(cv)) {
    if (predicted.usable(cv) && !settling(cv)) return predicted.values(cv);
  } else if (started_ && !settling(cv)) {
    return model_.output()(cv);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// No row may have residuals of either origin: those of one are long gone when the other one's
// begin, or are made so.
void Predictions::turn(std::size_t cv) {
  const bool simulated = !given_[cv] && started_ && settling_[cv] == 0;
  given_[cv] = !given_[cv];
  if (given_[cv])
    settling_[cv] = simulated ? kHeldSamples + 1 : 0;
  else
    settling_[cv] = started_ ? settling_samples_ : 0;
}

void Predictions::begin(const Frame& frame, const UnitInputs& inputs) {
  model_.set_time_s(1e-9 * static_cast<double>(frame.source_time_ns));
  for (int i = 0; i < model_.input_count(); ++i) distrust(i, inputs.unknown_run(i));
}

void Predictions::distrust(int input, std::int64_t unknown_run) {
  if (unknown_run <= kHeldSamples) return;
  const std::size_t cvs = given_.size();
  simulation_settles_ = settling_samples_;
  for (std::size_t j = 0; j < cvs; ++j)
    if (acts_[static_cast<std::size_t>(input) * cvs + j]) {
      if (unknown_run > lost_samples_) unseen_[j] = settling_samples_;
      if (!given_[j]) settling_[j] = settling_samples_;
    }
}

void Predictions::compare(const Frame& frame) {
  if (!started_ || !has_model_) return;
  const SignalBlock& measured = frame[SignalKind::kCv];
  const SignalBlock& predicted = frame[SignalKind::kPrediction];
  for (std::size_t j = 0; j < corrections_.size(); ++j) {
    const int cv = static_cast<int>(j);
    if (!may_predict_[j]) continue;
    if (measured.usable(cv) && predicted.usable(cv))
      corrections_[j].take(measured.values(cv), predicted.values(cv), model_.output()(cv));
    else
      corrections_[j].skip();
    // An integrator is where it is by what nobody measured.
    if (simulation_settles_ > 0 || integrating_[j])
      agreements_[j].skip();
    else if (predicted.usable(cv))
      agreements_[j].take(predicted.values(cv), model_.output()(cv));
  }
}

void Predictions::advance(const UnitInputs& inputs) {
  for (auto* each : {&settling_, &unseen_})
    for (std::int64_t& samples : *each)
      if (samples > 0) --samples;
  if (simulation_settles_ > 0) --simulation_settles_;
  // Where the plant stood before the first sample is unknown: at rest with the first inputs is the
  // least wrong; what is wrong about it decays.
  if (!started_) {
    if (!inputs.values().allFinite()) return;
    model_.reset_steady(inputs.values());
    started_ = true;
    simulation_settles_ = starting_samples_;
    for (std::size_t j = 0; j < given_.size(); ++j)
      if (!given_[j]) settling_[j] = starting_samples_;
  }
  model_.advance(inputs.held());
}

void Predictions::skip(std::int64_t missing, const UnitInputs& inputs) {
  for (FeedbackCorrection& correction : corrections_) correction.skip();
  // Where no CV was seen either, nothing that an input did was laid to another one.
  for (int i = 0; i < model_.input_count(); ++i)
    distrust(i, std::min<std::int64_t>(missing, lost_samples_));
  if (!started_) return;
  for (std::int64_t k = 0; k < std::min<std::int64_t>(missing, settling_samples_); ++k)
    model_.advance(inputs.held());
}

}  // namespace mpm
