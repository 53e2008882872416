#include "daemon/report/unit_performance.hpp"

#include <limits>

#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/horizons.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

CvPerformance cv_performance(const config::CvSignal& signal, const SignalLimits& limits,
                             const PerformanceSetup& setup, const CvSums& sums) {
  CvPerformance cv;
  cv.cv = signal.tag;
  cv.engineering_unit = signal.unit;
  if (!signal.setpoint.empty()) cv.setpoint = signal.setpoint;
  cv.samples = sums.known;
  cv.control_error = {sums.error.mean(), sums.error.variance(), sums.error.rms()};
  cv.outside_limits = limits.known() ? share_of(sums.outside, sums.known) : kUnknown;
  for (std::size_t h = 0; h < setup.horizons.size(); ++h)
    cv.prediction.push_back(
        {setup.horizons[h], sums.predictions[h].rmse(), sums.predictions[h].movement_rms()});
  return cv;
}

MvPerformance mv_performance(const config::InputSignal& signal, const SignalLimits& limits,
                             const MvSums& sums) {
  MvPerformance mv;
  mv.mv = signal.tag;
  mv.engineering_unit = signal.unit;
  mv.samples = sums.known;
  if (limits.low) mv.at_low = share_of(sums.at_low, sums.known);
  if (limits.high) mv.at_high = share_of(sums.at_high, sums.known);
  if (limits.known()) mv.at_limits = share_of(sums.at_limits, sums.known);
  if (sums.moves > 0) mv.travel = sums.travel / static_cast<double>(sums.moves);
  mv.standing = share_of(sums.standing, sums.known);
  return mv;
}

}  // namespace

PerformanceSetup performance_setup(const config::UnitConfig& unit) {
  PerformanceSetup setup;
  setup.counts = unit.counts();
  for (std::size_t i = 0; i < unit.mv.size(); ++i) setup.mv_limits.push_back(unit.mv_limits(i));
  for (std::size_t j = 0; j < unit.cv.size(); ++j) setup.cv_limits.push_back(unit.cv_limits(j));
  for (const Eigen::Index horizon :
       horizons_of(in_channels(unit.model), calibration::performance::kLongestHorizon))
    setup.horizons.push_back(horizon);
  return setup;
}

PerformanceRecord performance_record(const config::UnitConfig& unit, const PerformanceSetup& setup,
                                     const PerformanceSums& sums) {
  PerformanceRecord record;
  record.unit = unit.unit;
  record.samples = sums.samples;
  record.service_factor = share_of(sums.acting, sums.told);
  for (std::size_t j = 0; j < unit.cv.size(); ++j)
    record.cvs.push_back(cv_performance(unit.cv[j], setup.cv_limits[j], setup, sums.cvs[j]));
  for (std::size_t i = 0; i < unit.mv.size(); ++i)
    record.mvs.push_back(mv_performance(unit.mv[i], setup.mv_limits[i], sums.mvs[i]));
  return record;
}

nlohmann::ordered_json performance_json(const PerformanceRecord& record) {
  nlohmann::ordered_json json = json_of(record);
  for (const char* key : {"record", "unit", "interval", "time_ns", "window_samples"})
    json.erase(key);
  return json;
}

PerformanceTally::PerformanceTally(const config::UnitConfig& unit)
    : unit_(unit), frames_(unit.counts()), meter_(performance_setup(unit)), sums_(meter_.setup()) {}

void PerformanceTally::push(const Frame& frame, std::span<const JudgedFrame> judged) {
  if (!frames_.push(frame)) return;
  if (frames_.anew()) {
    meter_.begin_run();
    sums_.clear();
  }
  take();
  for (const JudgedFrame& one : judged) meter_.judge(one, sums_);
}

void PerformanceTally::take() {
  while (const Frame* frame = frames_.next()) meter_.take(*frame, sums_);
}

void PerformanceTally::begin_run() {
  frames_.end_run();
  take();
  meter_.begin_run();
}

PerformanceRecord PerformanceTally::record() const {
  PerformanceTally ended = *this;
  ended.begin_run();
  return performance_record(unit_, meter_.setup(), ended.sums_);
}

}  // namespace mpm::report
