#pragma once

#include <vector>

#include "core/alarm/condition.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/settings.hpp"

namespace mpm {

/// Settings with every "derive" filled in, in samples.
struct DerivedSettings {
  double lambda = 1.0;                         ///< forgetting factor of the partial correlations
  int ranked = 0;                              ///< samples that rank correlations are over
  std::vector<MemoryLength> memories;          ///< of the mismatch detector: long, fast
  int remembered = 0;                          ///< samples that a CV can start afresh from
  int evaluation_stride = 1;                   ///< samples from one evaluation of a CV to the next
  std::vector<MaterialityLimits> materiality;  ///< per channel, input-major
  double false_alarm_rate = 0.0;
  double gain_error_of_interest = 0.0;
  CorrelationKind correlation = CorrelationKind::kLaggedPartial;
  ThresholdKind threshold = ThresholdKind::kFTest;
  NonlinearTest nonlinear = NonlinearTest::kOff;
  int controlling_lags = 0;
  int first_lag = 0;
  int last_lag = 0;
  int fir_lags = 0;
  int residual_order = 0;
  std::vector<double> residual_poles;  ///< of the means of residuals beyond these lags
  std::vector<double> tail_poles;
  std::vector<double> outside_poles;  ///< of the means of signals that are no inputs
  std::vector<double> start_poles;    ///< of what a simulation's wrong start leaves behind
  int starting_samples = 0;           ///< until these poles are all that is left of it
  int settling_samples = 0;           ///< until a simulation has forgotten where it started
  Condition::Limits alarm;
};

/// The rules by which the user need not set anything; each is stated where it is applied.
[[nodiscard]] DerivedSettings derive_settings(const ModelSpec& spec, const LinearModel& model,
                                              const MonitorSettings& monitor,
                                              const AlarmSettings& alarms);

}  // namespace mpm
