#pragma once

#include <limits>

#include "core/mismatch/calibration.hpp"

namespace mpm {

/// Errors of a channel's model that do not matter, gain and time constant relative to the model's,
/// all > 0. Larger ones are material.
struct MaterialityLimits {
  double gain = calibration::materiality::kGain;
  double time_constant = calibration::materiality::kTimeConstant;
  double dead_time_samples = calibration::materiality::kDeadTimeSamples;
  /// Whatever of these is off, the step response is not by more than this (`StepErrors`).
  double step_response = calibration::materiality::kStepResponse;
  /// Where it is no error of gain, time constant or dead time, only its gain counts.
  bool gain_alone = false;

  template <class Archive>
  void archive(Archive& a) {
    a(gain, time_constant, dead_time_samples, step_response, gain_alone);
  }
};

/// An estimate with its standard deviation; the s.d. is infinite where nothing is known.
struct Estimate {
  double value = 0.0;
  double deviation = std::numeric_limits<double>::infinity();

  template <class Archive>
  void archive(Archive& a) {
    a(value, deviation);
  }
};

/// What the data say about one channel (input i to CV j).
struct ChannelEvidence {
  double statistic = 0.0;             ///< F of the test that says more
  double p_value = 1.0;               ///< tests * P(F > statistic) where the channel matches, <= 1
  double numerator_freedom = 0.0;     ///< of F; 0 = nothing to test with
  int tests = 1;                      ///< that were made
  double block_statistic = 0.0;       ///< F of the whole block
  double directed_statistic = 0.0;    ///< F of the usual errors
  int directed_freedom = 0;           ///< its numerator's; 0 = not tested
  double p_value_material = 1.0;      ///< the same where the error is within the limits, at most
  double reference_gain = 0.0;        ///< what 100 % means, CV units per input unit
  double gain_error_ratio = 0.0;      ///< (plant gain - model gain) / reference, were it only gain
  double excitation_index = 0.0;      ///< s.d. of gain_error_ratio; infinite = no information
  double excitation_index_alone = 0;  ///< the same, were the other inputs known not to matter
  int confounder = -1;                ///< input whose estimate is most correlated with this one's

  /// What the CV's regression by itself rejects, wrong channels of other CVs explain
  /// (`CoupledErrors`).
  bool elsewhere = false;
  bool usual = false;  ///< errors of gain, time constant and dead time explain all that is seen
  /// And all three are within the limits, or the step response is, with 95 % confidence.
  bool harmless = false;
  Estimate gain_error;       ///< relative to the reference gain, whatever else is wrong
  Estimate log_time_error;   ///< ln(plant's time constants / model's); meaningful if `usual`
  Estimate dead_time_error;  ///< samples, plant minus model; meaningful if `usual`
  Estimate step_error;       ///< of the step response (`StepErrors`); meaningful if `usual`
  /// How much of such an error does not matter: the limit, or more where other inputs undo most of
  /// what this one does.
  double step_limit = calibration::materiality::kStepResponse;
  double dead_time = 0.0;  ///< of the model, samples

  template <class Archive>
  void archive(Archive& a) {
    a(statistic, p_value, numerator_freedom, tests, block_statistic, directed_statistic,
      directed_freedom, p_value_material, reference_gain, gain_error_ratio, excitation_index,
      excitation_index_alone, confounder, elsewhere, usual, harmless, gain_error, log_time_error,
      dead_time_error, step_error, step_limit, dead_time);
  }
};

}  // namespace mpm
