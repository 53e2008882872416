#include "core/identify/evidence/channel_tests.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/identify/evidence/regress_recording.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/mismatch/coupled_cvs.hpp"
#include "core/mismatch/materiality.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

double mean_square_step(const Eigen::Ref<const VectorXd>& values) {
  double sum = 0.0, count = 0.0;
  for (Index k = 1; k < values.size(); ++k) {
    const double step = values(k) - values(k - 1);
    if (!std::isfinite(step)) continue;
    sum += step * step;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// All rows, where there are set-points and not too many rows; else 0, and none is followed.
Index rows_to_follow(const Recording& recording, OwnPast past) {
  const bool can = past == OwnPast::kLags && recording.setpoints.cols() > 0 &&
                   recording.samples() <= kMostRemembered;
  return can ? recording.samples() : 0;
}

double harmless_p_value_of(const ChannelEvidence& evidence, double freedom) {
  const MaterialityLimits limits;
  const double largest = std::min(
      {Materiality::beyond(evidence.gain_error, limits.gain, freedom),
       Materiality::beyond(evidence.log_time_error, std::log1p(limits.time_constant), freedom),
       Materiality::beyond(evidence.dead_time_error, limits.dead_time_samples, freedom)});
  const double step = evidence.step_error.value < evidence.step_limit ? 1.0 : 0.0;
  return std::min(evidence.p_value_material, std::max(largest, step));
}

}  // namespace

ChannelTests::ChannelTests(const ModelSpec& model, const Recording& recording,
                           const MatrixXd& residuals, OwnPast past)
    : cvs_(model.cv_count),
      p_values_(static_cast<std::size_t>(model.cv_count * model.input_count)),
      harmless_(p_values_.size(), 1.0),
      borne_(p_values_.size(), 1.0),
      gain_errors_(p_values_.size()),
      wrong_(p_values_.size(), 0.0),
      masked_(p_values_.size(), 1.0),
      bends_(p_values_.size(), false),
      setpoints_(static_cast<std::size_t>(model.cv_count), RivalSignal{.loses = false}),
      noise_before_(setpoints_.size()) {
  const Index to_follow = rows_to_follow(recording, past);
  const RegressedRecording regressed =
      regress_recording(model, recording, residuals, to_follow, past);
  if (!regressed.detector) return;
  MismatchDetector& detector = *regressed.detector;
  const auto ready = [&](int cv) {
    return detector.memory(cv).freedom() >= detector.shape().columns();
  };
  std::vector<const RegressionMemory*> memories(noise_before_.size(), nullptr);
  for (int cv = 0; cv < model.cv_count; ++cv) {  // what may be wrong of one counts for others
    detector.fold(cv);
    if (!ready(cv)) continue;
    detector.evaluate(cv);
    memories[static_cast<std::size_t>(cv)] = &detector.memory(cv);
  }
  CoupledCvs coupled(detector.shape());
  for (int cv = 0; cv < model.cv_count; ++cv) {
    if (!ready(cv)) continue;
    for (const CoupledCvs::Other& other : coupled.of(cv, memories))
      noise_before_[static_cast<std::size_t>(cv)].push_back(other.cv);
    detector.evaluate(cv);
    if (regressed.nonlinear) regressed.nonlinear->evaluate(cv, detector);
    const double steps = mean_square_step(residuals.col(cv));
    for (int input = 0; input < model.input_count; ++input) {
      const ChannelEvidence& evidence = detector.evidence(cv, input);
      if (!(evidence.numerator_freedom > 0.0)) continue;
      const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
      p_values_[channel] = evidence.p_value;
      harmless_[channel] = harmless_p_value_of(evidence, detector.memory(cv).freedom());
      borne_[channel] = evidence.p_value_material;
      gain_errors_[channel] = evidence.gain_error;
      if (evidence.excitation_index_alone > 0.0 && std::isfinite(evidence.excitation_index))
        masked_[channel] = evidence.excitation_index / evidence.excitation_index_alone;
      wrong_[channel] = evidence.statistic * steps;
      bends_[channel] = regressed.nonlinear && regressed.nonlinear->result(cv, input).verdict ==
                                                   NonlinearVerdict::kNonlinear;
    }
    if (to_follow > 0 && reject(channels_to(cv)))
      setpoints_[static_cast<std::size_t>(cv)] = detector.rival(
          cv, regressed.setpoints->followed(cv, detector.history(), detector.regression(cv),
                                            detector.usual_errors(cv)));
  }
}

std::vector<std::pair<int, int>> ChannelTests::channels_to(int cv) const {
  std::vector<std::pair<int, int>> channels(p_values_.size() / static_cast<std::size_t>(cvs_));
  for (std::size_t input = 0; input < channels.size(); ++input)
    channels[input] = {cv, static_cast<int>(input)};
  return channels;
}

bool ChannelTests::reject(const std::vector<std::pair<int, int>>& channels, double level) const {
  double smallest = 1.0;
  double tested = 0.0;
  for (const auto& [cv, input] : channels) {
    const std::optional<double> p = p_value(cv, input);
    if (!p) continue;
    smallest = std::min(smallest, *p);
    tested += 1.0;
  }
  return tested > 0.0 && smallest * tested <= level;
}

bool ChannelTests::bears(const std::vector<std::pair<int, int>>& channels, double level) const {
  return std::all_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& each) {
    const auto channel = static_cast<std::size_t>(each.second * cvs_ + each.first);
    return channel >= borne_.size() || borne_[channel] > level;
  });
}

bool ChannelTests::undone(const std::vector<std::pair<int, int>>& channels) const {
  return std::any_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& each) {
    const auto channel = static_cast<std::size_t>(each.second * cvs_ + each.first);
    return channel < masked_.size() && masked_[channel] > calibration::materiality::kUndone;
  });
}

bool ChannelTests::bends(const std::vector<std::pair<int, int>>& channels) const {
  return std::any_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& each) {
    const auto channel = static_cast<std::size_t>(each.second * cvs_ + each.first);
    return channel < bends_.size() && bends_[channel];
  });
}

bool ChannelTests::may_matter(const std::vector<std::pair<int, int>>& channels,
                              double level) const {
  return std::any_of(channels.begin(), channels.end(), [&](const std::pair<int, int>& channel) {
    return harmless_p_value(channel.first, channel.second) <= level;
  });
}

}  // namespace mpm
