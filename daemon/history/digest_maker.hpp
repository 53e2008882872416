#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "config/unit_config.hpp"
#include "core/performance/prediction_errors.hpp"
#include "daemon/history/digest.hpp"
#include "daemon/report/unit_monitor.hpp"

namespace mpm::history {

/// Digests of what a unit's monitor says. A digest is of a minute of source time, or of 5 or 15
/// where a minute has fewer than ten samples; all divide an hour and a zone's offset from UTC, so
/// that hours, days and weeks are whole digests.
class DigestMaker {
 public:
  explicit DigestMaker(const config::UnitConfig& unit);

  /// After each `monitor.push`. The digest of the stretch before, where the frame began another.
  [[nodiscard]] std::optional<Digest> push(const report::UnitMonitor& monitor);
  /// The digest of what came since the last one; nothing where that is nothing.
  [[nodiscard]] std::optional<Digest> finish();

  /// For samples from `time_ns` on.
  [[nodiscard]] UnitHead head(std::int64_t time_ns) const;

 private:
  struct Cv {
    std::int64_t known = 0;
    double residual_square = 0.0;
    PredictionSums predictions;
  };
  struct Channel {
    std::int64_t match = 0, mismatch = 0, excited = 0;
  };

  void take(const Monitor& monitor);
  void take_readings(const Monitor& monitor);
  [[nodiscard]] ChannelDigest digest_of(std::size_t channel) const;

  UnitHead head_;
  int inputs_, cv_count_;
  std::vector<std::string> mover_tags_;
  std::int64_t window_ns_;
  // Of the stretch at hand.
  std::int64_t window_ = 0;
  std::int64_t from_ns_ = 0, until_ns_ = 0, samples_ = 0;
  std::vector<Cv> cvs_;
  std::vector<Channel> channels_;
  std::vector<ChannelStatus> status_;  // after the last sample
  std::vector<AlarmState> alarms_;
  PredictionErrors predictions_;
  std::vector<CvReading> readings_;  // of the frame at hand
};

/// Of the horizon over which a CV's predictions are told: half of what the slowest channel of the
/// model takes to settle, in samples, at most an hour's worth of a unit of one second.
[[nodiscard]] std::int64_t horizon_samples(const config::UnitConfig& unit);

}  // namespace mpm::history
