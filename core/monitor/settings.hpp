#pragma once

#include <vector>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/correlation_kind.hpp"
#include "core/nonlinear/channel_nonlinearity.hpp"

namespace mpm {

/// What decides between match and mismatch.
enum class ThresholdKind {
  kFTest,     ///< the F tests of the mismatch detector
  kMeanLine,  ///< the thesis's mean line (core/mismatch/mean_line.hpp); not calibrated
};

/// Errors up to which a model is good enough: larger ones alarm.
struct MaterialitySettings {
  double gain = calibration::materiality::kGain;                   ///< relative to the model's
  double time_constant = calibration::materiality::kTimeConstant;  ///< relative to the model's
  double dead_time_s = 0.0;  ///< 0 = half a sample time, or a share of the time constant
  double step_response = calibration::materiality::kStepResponse;  ///< relative (`StepErrors`)
};

/// The same of one channel, in place of the unit's.
struct ChannelMateriality {
  int cv = 0;
  int input = 0;
  MaterialitySettings limits;
};

/// What the user may set; 0 or empty means "derive from the model and the sample time".
struct MonitorSettings {
  double memory_s = 0.0;           ///< sample_time / (1 - lambda); 0 = 4000 effective samples
  double fast_memory_s = 0.0;      ///< of the memory for sudden changes; 0 = 1000 effective samples
  bool sliding_window = false;     ///< the long memory is a window of the effective samples instead
  double false_alarm_rate = 0.01;  ///< of the whole unit at any one time, 0..1
  double gain_error_of_interest = 0.25;  ///< relative; larger errors must be visible to say match
  CorrelationKind correlation = CorrelationKind::kLaggedPartial;  ///< the one that is reported
  ThresholdKind threshold = ThresholdKind::kFTest;
  NonlinearTest nonlinear = NonlinearTest::kPolynomial;  ///< beside the linear test
  int controlling_lags = 40;                             ///< g of (3.15)
  int first_lag = -10;                                   ///< reported range of lags d of (3.15)
  int last_lag = 20;
  int fir_lags = 0;              ///< block length of the mismatch detector
  int residual_order = 0;        ///< lags of all residuals
  double tail_s = 0.0;           ///< time constant of the tail regressor
  int diagnosis_samples = 6000;  ///< kept for a diagnosis when an alarm stands; 0 = none is made
  double diagnosis_period_s = 600.0;      ///< between two diagnoses at least
  double performance_window_s = 28800.0;  ///< that live indices of control performance are over
  MaterialitySettings materiality;
  std::vector<ChannelMateriality> channel_materiality;
};

/// When a channel's verdict becomes an alarm.
struct AlarmSettings {
  double raise_p_value = 1e-7;  ///< raise below
  double clear_p_value = 1e-3;  ///< clear above (deadband between the two)
  double on_delay_s = 0.0;      ///< 0 = derive: 10 samples
  double off_delay_s = 0.0;     ///< 0 = derive: 60 samples
};

}  // namespace mpm
