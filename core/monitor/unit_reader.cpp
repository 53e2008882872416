#include "core/monitor/unit_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/archive/archive.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {
namespace {

// In which every channel begins to answer: however slow, it does so behind its dead time.
int answering_samples(const LinearModel& model, const DerivedSettings& derived) {
  const double dead_time = std::ceil(model.longest_dead_time_samples());
  return static_cast<int>(std::min(static_cast<double>(derived.settling_samples) + derived.fir_lags,
                                   dead_time + calibration::simulation::kBeginsToAnswer));
}

// A CV that has been unknown for so long has no verdict any more (`CvQuality`): only then is less
// lost than won where all begins anew.
int turning_samples(const DerivedSettings& derived) {
  return std::max(derived.settling_samples, static_cast<int>(calibration::bad_data::kShareSamples));
}

}  // namespace

UnitReader::UnitReader(const LinearModel& model, const SignalCounts& counts,
                       const std::vector<bool>& may_predict, const DerivedSettings& settings)
    : UnitReader(model, counts, may_predict, settings,
                 channels_of(model, answering_samples(model, settings))) {}

UnitReader::UnitReader(const LinearModel& model, const SignalCounts& counts,
                       const std::vector<bool>& may_predict, const DerivedSettings& settings,
                       const std::vector<bool>& acts)
    : screen_(counts, may_predict, acts,
              static_cast<int>(std::ceil(model.longest_dead_time_samples())),
              turning_samples(settings)),
      inputs_(counts, settings.remembered * calibration::input_motion::kMemoryShare),
      predictions_(
          model, may_predict, acts,
          simulates_some(may_predict) ? settings.starting_samples : settings.settling_samples,
          settings.settling_samples, settings.fir_lags),
      residuals_(counts.cv),
      predicted_(Eigen::VectorXd::Zero(counts.cv)) {
  turned_.reserve(static_cast<std::size_t>(counts.cv));
}

const Frame* UnitReader::next() {
  const Frame* frame = screen_.next();
  if (frame == nullptr) return nullptr;
  missing_ = samples_ == 0 ? 0 : frame->interval - interval_ - 1;
  interval_ = frame->interval;
  if (missing_ > 0) {
    residuals_.skip(missing_);
    predictions_.skip(missing_, inputs_);
  }
  turned_.clear();
  predictions_.follow(screen_, [&](int cv) { turned_.push_back(cv); });
  inputs_.read(*frame);
  predictions_.begin(*frame, inputs_);
  for (int j = 0; j < predicted_.size(); ++j) predicted_(j) = predictions_.predicted(j, *frame);
  residuals_.read(*frame, predicted_);
  predictions_.compare(*frame);
  predictions_.advance(inputs_);
  ++samples_;
  return frame;
}

void UnitReader::tell(const Frame& frame, JudgedFrame& judged) const {
  judged.interval = frame.interval;
  const SignalBlock& measured = frame[SignalKind::kCv];
  for (std::size_t j = 0; j < judged.readings.size(); ++j) {
    const int cv = static_cast<int>(j);
    judged.readings[j] = {
        measured.usable(cv) ? measured.values(cv) : std::numeric_limits<double>::quiet_NaN(),
        residuals_.values()(cv), screen_.learns(cv)};
  }
}

void UnitReader::archive(Archive& a) {
  // not archived: missing_, turned_, predicted_ (of each frame anew)
  a(screen_, inputs_, predictions_, residuals_, samples_, interval_);
}

}  // namespace mpm
