#include "core/identify/evidence/regress_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/identify/evidence/calibration.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/derived_settings.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

RegressionShape shape_of(const ModelSpec& model, const DerivedSettings& derived, OwnPast past) {
  RegressionShape shape{model.input_count, model.cv_count, derived.fir_lags, derived.residual_order,
                        derived.tail_poles};
  if (past == OwnPast::kAsMonitor) shape.residual_poles = derived.residual_poles;
  shape.bounded = past == OwnPast::kAsMonitor;
  return shape;
}

/// The monitor's regression, with ever fewer lags until the rows suffice for it; nothing where they
/// never do.
std::optional<DerivedSettings> settings_for(const ModelSpec& model, const LinearModel& linear,
                                            double rows, OwnPast past) {
  MonitorSettings monitor;
  for (;;) {
    DerivedSettings derived = derive_settings(model, linear, monitor, AlarmSettings{});
    if (kTestRowsPerColumn * shape_of(model, derived, past).columns() <= rows) return derived;
    if (derived.residual_order > kFewestResidualLags)
      monitor.residual_order = std::max(kFewestResidualLags, derived.residual_order / 2);
    else if (derived.fir_lags > kFewestLags)
      monitor.fir_lags = std::max(kFewestLags, derived.fir_lags / 2);
    else
      return std::nullopt;
  }
}

double fewest_known(const MatrixXd& residuals) {
  double fewest = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < residuals.cols(); ++j) {
    const auto known = static_cast<double>(residuals.col(j).array().isFinite().count());
    if (known > 0.0) fewest = std::min(fewest, known);
  }
  return std::isfinite(fewest) ? fewest : 0.0;
}

}  // namespace

RegressedRecording regress_recording(const ModelSpec& model, const Recording& recording,
                                     const MatrixXd& residuals, Index remembered, OwnPast past) {
  const LinearModel linear(model);
  const std::optional<DerivedSettings> settings =
      settings_for(model, linear, fewest_known(residuals), past);
  if (!settings) return {};
  const int depth = remembered > 0 ? static_cast<int>(remembered) : settings->remembered;
  RegressedRecording result;
  result.detector = std::make_unique<MismatchDetector>(shape_of(model, *settings, past),
                                                       std::vector{MemoryLength{}}, depth,
                                                       settings->evaluation_stride, linear);
  if (past == OwnPast::kLags && recording.setpoints.cols() > 0)
    result.setpoints = std::make_unique<OutsideSignals>(
        result.detector->shape(), static_cast<int>(recording.setpoints.cols()),
        settings->outside_poles, depth);
  if (past == OwnPast::kAsMonitor) {
    const double rate = settings->false_alarm_rate / (model.input_count * model.cv_count);
    result.nonlinear = std::make_unique<NonlinearDetector>(
        result.detector->shape(), linear,
        NonlinearDetector::Settings{settings->nonlinear, MemoryLength{},
                                    settings->evaluation_stride, rate,
                                    settings->gain_error_of_interest});
  }
  const auto take = [&](int cv) {
    result.detector->fold(cv);
    if (result.nonlinear) result.nonlinear->take(cv, *result.detector);
  };
  VectorXd inputs(model.input_count);
  auto border = recording.borders.begin();
  for (Index k = 0; k < recording.samples(); ++k) {
    if (border != recording.borders.end() && border->row == k) {
      const int apart = settings->fir_lags + settings->residual_order;  // no row has both sides
      for (int cv = 0; cv < model.cv_count; ++cv) take(cv);
      result.detector->skip(apart);
      if (result.nonlinear) result.nonlinear->skip(apart, *result.detector);
      if (result.setpoints) result.setpoints->skip(apart);
      ++border;
    }
    inputs.head(recording.inputs.cols()) = recording.inputs.row(k);
    inputs.tail(recording.aux.cols()) = recording.aux.row(k);
    result.detector->update(inputs, residuals.row(k).transpose());
    if (result.nonlinear) {
      result.nonlinear->add_sample(*result.detector);
      if ((k + 1) % settings->evaluation_stride == 0)
        for (int cv = 0; cv < model.cv_count; ++cv) take(cv);
    }
    if (result.setpoints) result.setpoints->push(recording.setpoints.row(k).transpose());
  }
  return result;
}

}  // namespace mpm
