#include "daemon/report/page/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mpm::report {
namespace {
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
}

Simulated fitted(const DiagnosisRun& run) {
  return {run.recording, run.diagnosis.before, run.diagnosis.after};
}

Simulated unseen(const DiagnosisRun& run) {
  return {*run.validation, run.diagnosis.validation_before, run.diagnosis.validation_after};
}

Series rows_of(const Eigen::MatrixXd& block, Eigen::Index column, const Run& rows) {
  if (column >= block.cols() || rows.first + rows.count > block.rows())
    return Series(static_cast<std::size_t>(rows.count), kNoValue);
  const double* first = block.col(column).data() + rows.first;
  return {first, first + rows.count};
}

Series input_rows(const DiagnosisRun& run, const Recording& recording, int input, const Run& rows) {
  const auto own = static_cast<int>(recording.inputs.cols());
  if (input < own) return rows_of(recording.inputs, input, rows);
  return rows_of(recording.aux, run.diagnosis.new_inputs.at(static_cast<std::size_t>(input - own)),
                 rows);
}

Series difference(const Series& a, const Series& b) {
  Series result(a.size(), kNoValue);
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) result[i] = a[i] - b[i];
  return result;
}

CvSeries cv_rows(const Simulated& data, Eigen::Index cv, const Run& rows) {
  CvSeries series;
  series.measured = rows_of(data.recording.cvs, cv, rows);
  series.before = rows_of(data.before, cv, rows);
  series.after = rows_of(data.after, cv, rows);
  series.residual_before = difference(series.measured, series.before);
  series.residual_after = difference(series.measured, series.after);
  return series;
}

double clock_at(const Recording& recording, Eigen::Index row) {
  return on_clock(recording,
                  recording.start_s + static_cast<double>(row) * recording.sample_time_s);
}

Track::Track(const Recording& recording, const std::vector<Run>& runs, std::size_t points)
    : runs_(runs), step_s_(recording.sample_time_s), clock_(true) {
  const auto start = [&](const Run& run) { return clock_at(recording, run.first); };
  std::sort(runs_.begin(), runs_.end(),
            [&](const Run& a, const Run& b) { return start(a) < start(b); });
  for (std::size_t r = 1; r < runs_.size(); ++r)
    if (start(runs_[r]) < start(runs_[r - 1]) + static_cast<double>(runs_[r - 1].count) * step_s_)
      clock_ = false;
  if (!clock_) runs_ = runs;
  std::size_t rows = 0;
  for (const Run& run : runs_) rows += static_cast<std::size_t>(run.count);
  every_ = thinning(rows, points);
  const double middle = 0.5 * static_cast<double>(every_ - 1) * step_s_;
  for (const Run& run : runs_) {
    starts_.push_back(clock_ ? start(run) : static_cast<double>(run.first) * step_s_);
    const std::size_t count = (static_cast<std::size_t>(run.count) + every_ - 1) / every_;
    stretches_.push_back({starts_.back() + middle, step_s_ * static_cast<double>(every_), count});
  }
}

double Track::at(Eigen::Index row) const {
  for (std::size_t r = 0; r < runs_.size(); ++r)
    if (row >= runs_[r].first && row < runs_[r].first + runs_[r].count)
      return starts_[r] + static_cast<double>(row - runs_[r].first) * step_s_;
  return kNoValue;
}

void Track::under(Plot& plot) const {
  if (clock_)
    plot.over_time(stretches_);
  else
    plot.over_span("time, runs one behind the other", stretches_);
}

Series Track::means(const Series& all) const {
  return along(all, [this](const Series& part) { return means_of(part, every_); });
}

void Track::draw(Plot& plot, const std::string& name, Role role, const Series& all) const {
  plot.line(name, role, means(all));
  if (every_ == 1 || role != Role::kMeasured) return;
  plot.band(role, along(all, [this](const Series& part) { return envelope_of(part, every_).low; }),
            along(all, [this](const Series& part) { return envelope_of(part, every_).high; }));
}

std::string axis_text(const std::string& tag, const std::string& unit) {
  return unit.empty() ? tag : tag + ", " + unit;
}

}  // namespace mpm::report
