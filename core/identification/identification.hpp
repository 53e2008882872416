#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/identification/channel_hint.hpp"
#include "core/identification/channel_shape.hpp"
#include "core/identification/damped_pair.hpp"
#include "core/identify/evidence/unanswered_pulses.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

struct IdentificationSettings {
  std::vector<ChannelHint> hints;  ///< what the user knows beforehand; at most one per channel
  int threads = 1;
  bool open_loop = false;  ///< the user says that no controller moved the inputs
};

/// Why a channel is not in the model.
enum class LeftOut {
  kIdentified,    ///< it is
  kGivenNone,     ///< the user says that there is no relation
  kStill,         ///< the input does not move
  kUnknownCv,     ///< the CV is hardly known, or does not move
  kReadSeldom,    ///< the CV is read only once in several samples (an analyser's)
  kTooFewRows,    ///< for so many inputs
  kOnlyFeedback,  ///< nothing but the CVs' own disturbances moves the input
  kHidden,        ///< moves too little, or too much like others, to tell
  kNoRelation,    ///< an effect that matters would have shown
  kTooSmall,      ///< there, but without importance
  kVague,         ///< there, but of unknown size
  kWrongSign,     ///< the data contradict the sign that the user gives
  kNotConfirmed,  ///< predictions of what was not fitted are no better with the inputs
};

struct Interval95 {
  double low = 0.0;
  double high = 0.0;
};

/// What the data say of one channel.
struct ChannelAnswer {
  int cv = 0;
  int input = 0;
  LeftOut left_out = LeftOut::kNoRelation;
  /// Where something was fitted, whether or not it is in the model. Seconds.
  std::optional<TransferFunction> dynamics = {};
  std::optional<DampedPair> pair = {};  ///< instead of time constants; s
  ChannelForm form = ChannelForm::kFirstOrder;
  Interval95 gain, dead_time_s;            ///< 95 %
  std::vector<Interval95> time_constants;  ///< 95 %, s; of a damped pair its time
  std::optional<Interval95> lead_s = {}, damping = {};
  /// Answer to a unit step, and its s.d.; times in s. Empty where nothing was fitted.
  std::vector<double> step_times_s, step, step_sd;
  double p_value = 1.0;       ///< of there being no relation
  double contribution = 0.0;  ///< s.d. of what it gives to that of the CV
  int entangled_with = -1;    ///< the input that a vague gain is traded against
  /// Where nothing was found: gain (CV units per input unit) that would have shown; infinite where
  /// none would.
  double visible_gain = 0.0;
};

/// How good the model of a CV is.
struct CvAnswer {
  int cv = 0;
  double rows = 0.0;            ///< that were fitted
  Eigen::Index read_every = 0;  ///< samples, as a rule; 0: it is read at every one
  double spread = 0.0;          ///< s.d. of the CV
  /// Fitted by the errors of the free run, for which no feedback and better carrying over speak.
  bool output_error = false;
  double noise_sd = 0.0;           ///< of what the model leaves, CV units
  double innovation_sd = 0.0;      ///< one step ahead, CV units
  double long_run_sd = 0.0;        ///< root of the noise's spectrum at frequency 0
  double whiteness_p_value = 1.0;  ///< of the innovations (Ljung and Box 1978)
  /// Per input: p-value of the innovations not depending on its past; 1 where it was not asked.
  std::vector<double> input_p_values;
  /// Of the free run on the last quarter: forms are chosen on it, numbers fitted to it as to the
  /// rest.
  double unseen_rmse = 0.0;
  double unseen_spread = 0.0;  ///< s.d. of the CV there
};

struct Identification {
  ModelSpec model;                      ///< the channels that were identified, operating point
  std::vector<ChannelAnswer> channels;  ///< all, CV by CV, inputs in order
  std::vector<CvAnswer> cvs;
  std::vector<std::optional<double>> outside_shares;  ///< of each input's movement
  std::vector<double> input_spread;                   ///< s.d. of each input; 0: it stands still
  /// Of no input depending on the CVs' past; 1 where the user says that none does.
  double feedback_p_value = 1.0;
  /// A CV goes with a test signal of its own row: it answers within the row.
  bool within_row = false;
  double longest_lag_s = 0.0;     ///< that was looked at
  std::vector<Pulse> unanswered;  ///< of inputs: taken as not known, for the plant saw none
};

/// Rows that an identification with so many inputs takes at least; fewer tell nothing.
[[nodiscard]] Eigen::Index needed_rows(Eigen::Index inputs);

/// A model from data alone.
[[nodiscard]] Identification identify(const Recording& recording,
                                      const IdentificationSettings& settings);

}  // namespace mpm
