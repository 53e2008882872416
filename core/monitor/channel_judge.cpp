#include "core/monitor/channel_judge.hpp"

#include <algorithm>
#include <cmath>

#include "core/monitor/calibration.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

namespace visibility = calibration::visibility;

bool alarmed(const JudgedChannel& channel) {
  return channel.alarms.state(channel.input) == AlarmState::kActive;
}

double smallest_error(const ChannelEvidence& evidence) {
  return std::min(visibility::kSeenDeviations * evidence.excitation_index,
                  visibility::kBlindGainError);
}

}  // namespace

ChannelJudge::ChannelJudge(const SignalCounts& counts, const DerivedSettings& settings)
    : mvs_(counts.mv),
      inputs_(counts.inputs()),
      gain_error_of_interest_(settings.gain_error_of_interest),
      mean_line_(settings.threshold == ThresholdKind::kMeanLine),
      channel_rate_(settings.false_alarm_rate / (counts.inputs() * counts.cv)) {}

bool ChannelJudge::shows_errors(const ChannelEvidence& evidence) const {
  return smallest_error(evidence) <= gain_error_of_interest_;
}

void ChannelJudge::judge(const JudgedChannel& channel, ChannelStatus& status) {
  status.effective_samples = channel.memory.effective_rows();
  status.confounder = -1;
  status.verdict = Verdict::kUndetermined;
  if (!has_evidence(channel, status)) return;
  read_evidence(channel, status);
  status.gain_variation = channel.gain_variation;
  const bool exceeding = exceeds(channel, status);
  if (exceeding && channel.confounded) {
    status.reason = Reason::kConfounded;
    status.confounder = channel.confounder;
    return;
  }
  if (!exceeding && channel.bends && status.excited) {
    status.verdict = Verdict::kMismatch;
    status.reason = Reason::kOperatingPoint;
    return;
  }
  if (exceeding && !alarmed(channel) && !channel.belief.has(channel.evidence)) {
    status.reason = Reason::kCoarse;
    return;
  }
  const bool convincing = status.smallest_error < visibility::kBlindGainError &&
                          status.p_value < visibility::kConvincing * channel_rate_;
  if (status.excited || ((convincing || alarmed(channel)) && exceeding)) {
    status.verdict = exceeding ? Verdict::kMismatch : Verdict::kMatch;
    status.reason = status.excited ? Reason::kNone : Reason::kWeakExcitation;
    return;
  }
  status.reason = why_not_excited(channel);
  if (status.reason == Reason::kCollinear) status.confounder = channel.evidence.confounder;
}

bool ChannelJudge::has_evidence(const JudgedChannel& channel, ChannelStatus& status) {
  if (channel.bad_data != Reason::kNone) {
    status.reason = channel.bad_data;
    status.confounder = channel.spoilt;
    return false;
  }
  const bool isolating = channel.alarms.isolating();
  if (channel.memory.ready() && !isolating) return true;
  const double effective_samples = status.effective_samples;
  status = ChannelStatus{};  // what was known before says nothing now
  status.effective_samples = effective_samples;
  if (isolating && alarmed(channel)) read_change(channel, status);
  status.reason = isolating         ? Reason::kIsolating
                  : channel.overdue ? Reason::kBadData
                                    : Reason::kWarmingUp;
  return false;
}

// That something changed is beyond doubt, by how much is not known yet.
void ChannelJudge::read_change(const JudgedChannel& channel, ChannelStatus& status) {
  const ChangePoint& change = channel.alarms.change();
  status.p_value = change.p_value;
  status.statistic = change.statistic;
  status.threshold = thresholds_.at(change.numerator, change.denominator, inputs_, channel_rate_);
  status.model_gain = channel.evidence.reference_gain;
  status.effect_high = visibility::kBlindGainError * std::abs(status.model_gain);
  status.effect_low = -status.effect_high;
}

void ChannelJudge::read_evidence(const JudgedChannel& channel, ChannelStatus& status) {
  const ChannelEvidence& evidence = channel.evidence;
  status.p_value = evidence.p_value;
  status.p_value_material = evidence.p_value_material;
  status.statistic = evidence.statistic;
  status.threshold = thresholds_.at(evidence.numerator_freedom, channel.memory.freedom(),
                                    evidence.tests, channel_rate_);
  status.model_gain = evidence.reference_gain;
  status.usual = evidence.usual;
  status.log_time_error = evidence.log_time_error;
  status.dead_time_error = evidence.dead_time_error;
  status.dead_time = evidence.dead_time;
  const double half =
      kNormalTwoSided95 * std::min(evidence.gain_error.deviation, visibility::kBlindGainError);
  status.effect_size = std::clamp(evidence.gain_error.value, -visibility::kBlindGainError,
                                  visibility::kBlindGainError) *
                       evidence.reference_gain;
  status.effect_low = status.effect_size - half * std::abs(evidence.reference_gain);
  status.effect_high = status.effect_size + half * std::abs(evidence.reference_gain);
  status.smallest_error = smallest_error(evidence);
  status.excited = shows_errors(evidence);
  status.material = alarmed(channel) || evidence.p_value_material < channel_rate_;
}

bool ChannelJudge::exceeds(const JudgedChannel& channel, ChannelStatus& status) const {
  if (!mean_line_) return unlikely(channel.evidence) || alarmed(channel);
  status.partial_correlation = channel.peak.value;
  status.lag = channel.peak.lag;
  status.statistic = std::abs(status.partial_correlation);
  status.threshold = channel.mean_line;
  return status.statistic > status.threshold;
}

Reason ChannelJudge::why_not_excited(const JudgedChannel& channel) const {
  const ChannelEvidence& evidence = channel.evidence;
  if (channel.mvs_still && channel.input < mvs_) return Reason::kControllerOff;
  const bool seen_alone =
      visibility::kSeenDeviations * evidence.excitation_index_alone <= gain_error_of_interest_;
  if (seen_alone && evidence.confounder >= 0) return Reason::kCollinear;
  return channel.at_limit ? Reason::kConstrained : Reason::kNotExcited;
}

}  // namespace mpm
