#include "core/monitor/reported_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/mean_line.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {

ReportedCorrelation::ReportedCorrelation(const SignalCounts& counts,
                                         const DerivedSettings& settings)
    : first_lag_(settings.first_lag),
      correlation_({counts.inputs(), counts.cv, settings.controlling_lags, settings.first_lag,
                    settings.last_lag, settings.correlation},
                   settings.lambda) {}

void ReportedCorrelation::take(const UnitInputs& inputs, const UnitResiduals& residuals) {
  current_ = false;
  const bool close = inputs.longest_unknown_run() <= calibration::bad_data::kHeldSamples &&
                     residuals.longest_unknown_run() <= calibration::bad_data::kHeldSamples;
  if (close)
    correlation_.update(inputs.held(), residuals.held());
  else
    correlation_.close_window();
}

void ReportedCorrelation::evaluate() {
  if (current_) return;
  correlation_.evaluate();
  current_ = true;
}

CorrelationPeak ReportedCorrelation::peak(int cv, int input) const {
  const Eigen::Ref<const Eigen::VectorXd> correlations = values(cv, input);
  CorrelationPeak peak;
  const int last_lag = first_lag_ + correlation_.lag_count() - 1;
  for (int d = std::max(1, first_lag_); d <= last_lag; ++d) {
    const double value = correlations(d - first_lag_);
    if (std::abs(value) > std::abs(peak.value)) peak = {value, d};
  }
  return peak;
}

double ReportedCorrelation::mean_line() const { return mpm::mean_line(correlation_); }

}  // namespace mpm
