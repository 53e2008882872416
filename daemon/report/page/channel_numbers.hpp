#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/model/model_spec.hpp"
#include "daemon/report/diagnosis/diagnosis_run.hpp"
#include "daemon/report/identification/identification_run.hpp"

/// Gain, time constants and dead time of each channel, as it is typed into a controller, in the
/// given model and in the new one.
namespace mpm::report {

/// NaN where it is not known: there is no such channel, or its form has no such number.
struct OldAndNew {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double old_value = kUnknown;
  double new_value = kUnknown;
  double low = kUnknown, high = kUnknown;  ///< 95 % interval of the new one
};

struct ChannelNumbers {
  int cv = 0;
  int input = 0;
  bool integrating = false;
  OldAndNew gain;                         ///< CV units per input unit (and s where it integrates)
  std::vector<OldAndNew> time_constants;  ///< s
  OldAndNew lead;                         ///< s; 0 or unknown: none
  OldAndNew dead_time;                    ///< s
  /// Of a pair that overshoots, whose time is the one time constant; the interval is that of the
  /// fit.
  std::optional<OldAndNew> damping = {};

  [[nodiscard]] bool has_lead() const;
  /// By so much that somebody would type it anew; what a fit moves along with it is less.
  [[nodiscard]] bool changed(double sample_time_s) const;
};

/// Of every channel of either model, CV by CV. A gain is that of small moves around where the plant
/// was operated, the medians of the recorded inputs, with what static blocks make of it.
[[nodiscard]] std::vector<ChannelNumbers> channel_numbers(const DiagnosisRun& run);
/// Of every channel that was identified; old values where the unit file had a model.
[[nodiscard]] std::vector<ChannelNumbers> channel_numbers(const IdentificationRun& run);

/// The table of the page: rows, and the same as CSV.
[[nodiscard]] nlohmann::ordered_json numbers_json(const std::vector<ChannelNumbers>& channels,
                                                  const config::UnitConfig& unit);

}  // namespace mpm::report
