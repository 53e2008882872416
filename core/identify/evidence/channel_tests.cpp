#include "core/identify/evidence/channel_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/mismatch/change_scan.hpp"
#include "core/mismatch/mismatch_detector.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/derived_settings.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Without means of the CVs' own past: a loop that swings by itself, as with a sticking valve, is
/// predicted by these as well as by its input.
RegressionShape shape_of(const ModelSpec& model, const DerivedSettings& derived) {
  return {model.input_count, model.cv_count, derived.fir_lags, derived.residual_order,
          derived.tail_poles};
}

/// The monitor's regression, with ever fewer lags until the rows suffice for it; nothing where they
/// never do.
std::optional<DerivedSettings> settings_for(const ModelSpec& model, const LinearModel& linear,
                                            double rows) {
  MonitorSettings monitor;
  for (;;) {
    DerivedSettings derived = derive_settings(model, linear, monitor, AlarmSettings{});
    if (kTestRowsPerColumn * shape_of(model, derived).columns() <= rows) return derived;
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

double mean_square_step(const Eigen::Ref<const VectorXd>& values) {
  double sum = 0.0, count = 0.0;
  for (Index k = 1; k < values.size(); ++k) {
    const double step = values(k) - values(k - 1);
    if (!std::isfinite(step)) continue;
    sum += step * step;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

ChannelTests::ChannelTests(const ModelSpec& model, const Recording& recording,
                           const MatrixXd& residuals)
    : cvs_(model.cv_count),
      p_values_(static_cast<std::size_t>(model.cv_count * model.input_count)),
      wrong_(p_values_.size(), 0.0) {
  const LinearModel linear(model);
  const std::optional<DerivedSettings> settings =
      settings_for(model, linear, fewest_known(residuals));
  if (!settings) return;
  const RegressionShape shape = shape_of(model, *settings);
  const auto remembered = static_cast<int>(std::min(recording.samples(), kMostRemembered));
  MismatchDetector detector(shape, {MemoryLength{}}, remembered, settings->evaluation_stride,
                            linear);
  VectorXd inputs(model.input_count);
  auto border = recording.borders.begin();
  for (Index k = 0; k < recording.samples(); ++k) {
    if (border != recording.borders.end() && border->row == k) {
      detector.skip(settings->fir_lags + settings->residual_order);  // no row has both sides
      ++border;
    }
    inputs.head(recording.inputs.cols()) = recording.inputs.row(k);
    inputs.tail(recording.aux.cols()) = recording.aux.row(k);
    detector.update(inputs, residuals.row(k).transpose());
  }
  for (int cv = 0; cv < model.cv_count; ++cv) {
    detector.fold(cv);
    if (!(detector.memory(cv).freedom() >= shape.columns())) continue;
    detector.evaluate(cv);
    const double steps = mean_square_step(residuals.col(cv));
    for (int input = 0; input < model.input_count; ++input) {
      const ChannelEvidence& evidence = detector.evidence(cv, input);
      if (!(evidence.numerator_freedom > 0.0)) continue;
      const auto channel = static_cast<std::size_t>(input * cvs_ + cv);
      p_values_[channel] = evidence.p_value;
      wrong_[channel] = evidence.statistic * steps;
    }
  }
  if (recording.borders.empty() && recording.samples() <= kMostRemembered)
    date_change(detector, recording.samples());
}

// Of CVs whose channels match nothing is asked: what wanders would be dated.
void ChannelTests::date_change(const MismatchDetector& detector, Index samples) {
  const RegressionShape& shape = detector.shape();
  ChangeScan scan(shape);
  double gain = 0.0;
  for (int cv = 0; cv < cvs_; ++cv) {
    std::vector<std::pair<int, int>> channels;
    channels.reserve(static_cast<std::size_t>(shape.inputs));
    for (int input = 0; input < shape.inputs; ++input) channels.emplace_back(cv, input);
    if (!reject(channels)) continue;
    const std::optional<ChangePoint> change = scan.scan(detector, cv);
    if (!change || change->kind == ChangeKind::kEnded || !(change->gain > gain)) continue;
    gain = change->gain;
    change_row_ = samples - change->samples;
  }
}

bool ChannelTests::reject(const std::vector<std::pair<int, int>>& channels, double level) const {
  double smallest = 1.0;
  double tested = 0.0;
  for (const auto& [cv, input] : channels) {
    const std::optional<double> p = p_value(cv, input);
    if (!p) continue;
    smallest = std::min(smallest, *p);
    tested += 1.0;
  }
  return tested > 0.0 && smallest * tested <= level;
}

}  // namespace mpm
