#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/field_key.hpp"

namespace mpm {

/// Measured minus set-point, CV units; NaN where no sample has both.
struct ControlError {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double variance = std::numeric_limits<double>::quiet_NaN();  ///< about the mean, n - 1
  double rms = std::numeric_limits<double>::quiet_NaN();

  /// In JSON it is null where not.
  [[nodiscard]] bool known() const { return std::isfinite(mean); }

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("mean", record.mean, sample.mean...);
    visit("variance", record.variance, sample.variance...);
    visit("rms", record.rms, sample.rms...);
  }
};

/// Predictions over one horizon, CV units; NaN where none could be judged.
struct HorizonError {
  std::int64_t samples = 0;  ///< ahead
  double rmse = std::numeric_limits<double>::quiet_NaN();
  double movement_rms = std::numeric_limits<double>::quiet_NaN();  ///< of the CV itself meanwhile

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("samples", record.samples, sample.samples...);
    visit("rmse", record.rmse, sample.rmse...);
    visit("movement_rms", record.movement_rms, sample.movement_rms...);
  }
};

/// How one CV is controlled and predicted.
struct CvPerformance {
  std::string cv;                       ///< tag
  std::string engineering_unit;         ///< may be empty
  std::optional<std::string> setpoint;  ///< tag; none where it has none
  std::int64_t samples = 0;             ///< in which it was measured
  ControlError control_error;
  double outside_limits = std::numeric_limits<double>::quiet_NaN();  ///< share of the samples, 0..1
  std::vector<HorizonError> prediction;

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("cv", record.cv, sample.cv...);
    visit("unit", record.engineering_unit, sample.unit...);
    visit("setpoint", record.setpoint, sample.setpoint...);
    visit("samples", record.samples, sample.samples...);
    visit("control_error", record.control_error, sample.control_error...);
    visit("outside_limits", record.outside_limits, sample.outside_limits...);
    visit("prediction", record.prediction, sample.prediction...);
  }
};

/// How one MV is used: shares of its samples, 0..1; NaN where its limits or its values are unknown.
struct MvPerformance {
  std::string mv;                ///< tag
  std::string engineering_unit;  ///< may be empty
  std::int64_t samples = 0;      ///< in which it was known
  double at_low = std::numeric_limits<double>::quiet_NaN();
  double at_high = std::numeric_limits<double>::quiet_NaN();
  double at_limits = std::numeric_limits<double>::quiet_NaN();  ///< at either
  double travel = std::numeric_limits<double>::quiet_NaN();    ///< mean |move|, MV units per sample
  double standing = std::numeric_limits<double>::quiet_NaN();  ///< in a stand-still run

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("mv", record.mv, sample.mv...);
    visit("unit", record.engineering_unit, sample.unit...);
    visit("samples", record.samples, sample.samples...);
    visit("at_low", record.at_low, sample.at_low...);
    visit("at_high", record.at_high, sample.at_high...);
    visit("at_limits", record.at_limits, sample.at_limits...);
    visit("travel", record.travel, sample.travel...);
    visit("standing", record.standing, sample.standing...);
  }
};

/// How well a unit is controlled, over some samples; topic mpm/performance.
struct PerformanceRecord {
  std::string unit;
  std::int64_t interval = 0;  ///< of the last sample
  std::int64_t source_time_ns = 0;
  std::int64_t window_samples = 0;  ///< looked back at most
  std::int64_t samples = 0;         ///< that came in these
  /// Share of the samples in which the controller acts, 0..1; NaN where it cannot be told.
  double service_factor = std::numeric_limits<double>::quiet_NaN();
  std::vector<CvPerformance> cvs;
  std::vector<MvPerformance> mvs;

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("record", std::string_view("performance"));
    visit("unit", record.unit, sample.unit...);
    visit("interval", record.interval, sample.interval...);
    visit("time_ns", record.source_time_ns, sample.source_time_ns...);
    visit("window_samples", record.window_samples, sample.window_samples...);
    visit("samples", record.samples, sample.samples...);
    visit("service_factor", record.service_factor, sample.service_factor...);
    visit("cvs", record.cvs, sample.cvs...);
    visit("mvs", record.mvs, sample.mvs...);
  }
};

}  // namespace mpm
