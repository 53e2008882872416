#pragma once

#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/regression_memory.hpp"
#include "core/mismatch/verdict.hpp"
#include "core/monitor/belief.hpp"
#include "core/monitor/cv_alarms.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/f_thresholds.hpp"
#include "core/monitor/reported_correlation.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

/// What a verdict on one channel rests on, after one sample.
struct JudgedChannel {
  int input = 0;
  Reason bad_data = Reason::kNone;  ///< why no verdict can be drawn of these data, if none can
  int spoilt = -1;                  ///< another input that is to blame for `bad_data`
  bool overdue = false;             ///< there ought to be rows enough by now
  const RegressionMemory& memory;   ///< the CV's long one
  const ChannelEvidence& evidence;
  const CvAlarms& alarms;       ///< the CV's
  bool mvs_still = false;       ///< no MV moves
  bool at_limit = false;        ///< the input rests at the end of its range
  bool confounded = false;      ///< what is off in the CV may be no error of its channels
  int confounder = -1;          ///< and follows this signal, as in ChannelStatus; -1: none logged
  CorrelationPeak peak;         ///< with ThresholdKind::kMeanLine, else unused
  double mean_line = 0.0;       ///< likewise
  double gain_variation = 0.0;  ///< as in ChannelStatus
  bool bends = false;           ///< and for certain by more than matters
  Belief belief;                ///< in evidence of the CV
};

/// Turns evidence into verdicts: first whether there can be one at all, then whether an error of
/// interest would show, and only then the p-value (or the mean line). No allocation after
/// construction.
class ChannelJudge {
 public:
  ChannelJudge(const SignalCounts& counts, const DerivedSettings& settings);

  /// The evidence speaks against the channel.
  [[nodiscard]] bool unlikely(const ChannelEvidence& evidence) const {
    return evidence.p_value < channel_rate_;
  }
  /// An error of interest would show.
  [[nodiscard]] bool shows_errors(const ChannelEvidence& evidence) const;
  /// Brings the status up to the sample, but for the reported correlation.
  void judge(const JudgedChannel& channel, ChannelStatus& status);

  template <class Archive>
  void archive(Archive& a) {
    // not archived: mvs_, inputs_, gain_error_of_interest_, mean_line_, channel_rate_
    // (construction)
    a(thresholds_);
  }

 private:
  [[nodiscard]] bool has_evidence(const JudgedChannel& channel, ChannelStatus& status);
  void read_change(const JudgedChannel& channel, ChannelStatus& status);
  void read_evidence(const JudgedChannel& channel, ChannelStatus& status);
  [[nodiscard]] bool exceeds(const JudgedChannel& channel, ChannelStatus& status) const;
  [[nodiscard]] Reason why_not_excited(const JudgedChannel& channel) const;

  int mvs_, inputs_;
  double gain_error_of_interest_;
  bool mean_line_;
  double channel_rate_;  // false alarms of one channel
  FThresholds thresholds_;
};

}  // namespace mpm
