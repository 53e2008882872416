#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/mismatch/channel_evidence.hpp"
#include "core/text/words.hpp"

namespace mpm {

enum class Verdict : std::uint8_t { kUndetermined, kMatch, kMismatch };

/// Why a verdict is undetermined; of a mismatch, what is to be known of it.
enum class Reason : std::uint8_t {
  kNone,
  kWarmingUp,       ///< too few effective samples yet
  kNotExcited,      ///< the input did not move enough to show an error of interest
  kCollinear,       ///< the input moved only together with another one (`confounder`)
  kConfounded,      ///< what is off in this CV follows a signal that is no input (`confounder`)
  kBadData,         ///< too many of the values needed are missing, bad or implausible
  kCompressed,      ///< a historian has compressed the CV, or an input from which it is simulated
                    ///< (`confounder`): what was held or drawn is no measurement
  kControllerOff,   ///< no manipulated variable moves: the controller is off or in manual
  kConstrained,     ///< the input sits at a limit
  kIsolating,       ///< something in this CV changed; samples since then are still too few
  kWeakExcitation,  ///< a mismatch: it shows, though an error of interest need not have shown
  kOperatingPoint,  ///< a mismatch: the gain varies over where the plant is operated
  kCoarse,          ///< something is off in the CV, which its coarse readings may make up
};

[[nodiscard]] constexpr auto words_of(Verdict) {
  return std::array{"undetermined", "match", "mismatch"};
}

[[nodiscard]] constexpr auto words_of(Reason) {
  return std::array{"",           "warming_up",      "not_excited",
                    "collinear",  "confounded",      "bad_data",
                    "compressed", "controller_off",  "constrained",
                    "isolating",  "weak_excitation", "operating_point",
                    "coarse"};
}

/// The numbers behind a verdict that an alarm repeats.
struct AlarmEvidence {
  double p_value = 1.0;              ///< of the F test of the channel, 0..1
  double statistic = 0.0;            ///< its F; |correlation| with the mean line
  double threshold = 0.0;            ///< of the statistic, where the verdict turns to mismatch
  double partial_correlation = 0.0;  ///< where its magnitude is largest for lags >= 1; (3.15), or
                                     ///< the kind that the settings name
  int lag = 0;                       ///< samples, where that is
  double effect_size = 0.0;          ///< estimated gain error, plant minus model, CV per input unit

  template <class Archive>
  void archive(Archive& a) {
    a(p_value, statistic, threshold, partial_correlation, lag, effect_size);
  }
};

/// What is said of one channel as it stands (core/record/channel_record.hpp).
struct ChannelVerdict : AlarmEvidence {
  Verdict verdict = Verdict::kUndetermined;
  Reason reason = Reason::kWarmingUp;
  bool excited = false;
  double p_value_material = 1.0;  ///< that the error is within the materiality limits, at most
  bool material = false;          ///< the error matters: it is beyond them
  double model_gain = 0.0;        ///< what 100 % means, CV per input unit
  double effect_low = 0.0;        ///< 95 % interval of effect_size
  double effect_high = 0.0;
  bool usual = false;  ///< errors of gain, time constant and dead time explain what is seen
  double smallest_error = 0.0;  ///< smallest relative gain error that would have been seen, >= 0
  double effective_samples = 0.0;
  /// Two s.d. of the local gain over where the plant was operated, relative to the model's; NaN
  /// unless the CV's answer is known to depend on that.
  double gain_variation = std::numeric_limits<double>::quiet_NaN();

  template <class Archive>
  void archive(Archive& a) {
    AlarmEvidence::archive(a);
    a.within(verdict, Verdict::kUndetermined, Verdict::kMismatch);
    a.within(reason, Reason::kNone, Reason::kCoarse);
    a(excited, p_value_material, material, model_gain, effect_low, effect_high, usual,
      smallest_error, effective_samples, gain_variation);
  }
};

/// Judgement on one channel (one input to one CV) after one sample.
struct ChannelStatus : ChannelVerdict {
  /// For kCollinear, kConfounded, and kBadData where another input is lost: of the inputs, the CVs'
  /// set-points and the auxiliary signals, counted in this order; -1 otherwise.
  int confounder = -1;
  Estimate log_time_error;   ///< ln(plant's time constants / model's); meaningful if `usual`
  Estimate dead_time_error;  ///< samples, plant minus model; meaningful if `usual`
  double dead_time = 0.0;    ///< of the model, samples

  template <class Archive>
  void archive(Archive& a) {
    ChannelVerdict::archive(a);
    a(confounder, log_time_error, dead_time_error, dead_time);
  }
};

}  // namespace mpm
