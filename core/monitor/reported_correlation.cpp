#include "core/monitor/reported_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "core/mismatch/mean_line.hpp"
#include "core/monitor/calibration.hpp"

namespace mpm {
namespace {

std::variant<LaggedCorrelation, RankCorrelation> of_kind(const SignalCounts& counts,
                                                         const DerivedSettings& settings) {
  if (of_ranks(settings.correlation))
    return RankCorrelation({counts.inputs(), counts.cv, settings.first_lag, settings.last_lag,
                            settings.correlation == CorrelationKind::kRankPartial},
                           settings.ranked);
  return LaggedCorrelation({counts.inputs(), counts.cv, settings.controlling_lags,
                            settings.first_lag, settings.last_lag, settings.correlation},
                           settings.lambda);
}

}  // namespace

ReportedCorrelation::ReportedCorrelation(const SignalCounts& counts,
                                         const DerivedSettings& settings)
    : first_lag_(settings.first_lag),
      last_lag_(settings.last_lag),
      correlation_(of_kind(counts, settings)) {}

void ReportedCorrelation::take(const UnitInputs& inputs, const UnitResiduals& residuals) {
  current_ = false;
  const bool close = inputs.longest_unknown_run() <= calibration::bad_data::kHeldSamples &&
                     residuals.longest_unknown_run() <= calibration::bad_data::kHeldSamples;
  if (!close) return close_window();
  std::visit([&](auto& correlation) { correlation.update(inputs.held(), residuals.held()); },
             correlation_);
}

void ReportedCorrelation::evaluate() {
  if (current_) return;
  std::visit([](auto& correlation) { correlation.evaluate(); }, correlation_);
  current_ = true;
}

CorrelationPeak ReportedCorrelation::peak(int cv, int input) const {
  const Eigen::Ref<const Eigen::VectorXd> correlations = values(cv, input);
  CorrelationPeak peak;
  for (int d = std::max(1, first_lag_); d <= last_lag_; ++d) {
    const double value = correlations(d - first_lag_);
    if (std::abs(value) > std::abs(peak.value)) peak = {value, d};
  }
  return peak;
}

double ReportedCorrelation::mean_line() const {
  const auto* correlation = std::get_if<LaggedCorrelation>(&correlation_);
  return correlation != nullptr ? mpm::mean_line(*correlation) : 0.0;
}

}  // namespace mpm
