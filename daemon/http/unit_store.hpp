#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/unit_config.hpp"
#include "core/parallel/mutex.hpp"
#include "daemon/http/history.hpp"
#include "daemon/http/recent_events.hpp"
#include "daemon/http/unit_feed.hpp"
#include "daemon/http/unit_snapshot.hpp"

namespace mpm::http {

/// Where 95 % of a CV's residuals were while no channel of it was said to mismatch.
struct ResidualBand {
  double mean = 0.0, deviation = 0.0;
  std::int64_t samples = 0;
  /// Fewer are no band: a swing of a setpoint or two.
  static constexpr std::int64_t kFewest = 300;
};

/// Indices of a unit over time: one row a digest.
enum class KpiColumn : int { kAccuracy, kDetermined };
inline constexpr int kKpiColumns = 2;

/// All that is kept of one unit for who looks at it. One thread absorbs, any reads.
class UnitStore {
 public:
  using Clock = std::chrono::steady_clock;

  /// `events`: takes the unit's alarm events; must outlive this.
  UnitStore(const config::UnitConfig& unit, RecentEvents& events);

  /// What a journal says of the time before all that is absorbed, oldest first.
  void recall(const history::Digest& digest);
  /// True where it can be seen: there is another snapshot.
  bool absorb(Delivery& delivery, Clock::time_point now);

  [[nodiscard]] const config::UnitConfig& config() const { return config_; }
  [[nodiscard]] const FeedColumns& columns() const { return columns_; }
  /// Column of a CV's residual in `draw`, whose others are those of `columns`.
  [[nodiscard]] int residual(int cv) const { return columns_.width() + cv; }
  [[nodiscard]] std::shared_ptr<const UnitSnapshot> snapshot() const;
  /// The last value of a column; NaN where it is not known.
  [[nodiscard]] double latest(int column) const;
  /// From the first to the last row; nothing where there is none.
  [[nodiscard]] std::optional<std::pair<std::int64_t, std::int64_t>> extent() const;
  [[nodiscard]] Drawing draw(std::int64_t from_ns, std::int64_t until_ns, int points,
                             const std::vector<int>& columns) const;
  [[nodiscard]] Drawing draw_kpi(int points) const;
  [[nodiscard]] ResidualBand band(int cv) const;
  [[nodiscard]] std::optional<live::DiagnosisOutcome> diagnosis() const;
  [[nodiscard]] double samples_per_second() const;
  [[nodiscard]] std::uint64_t dropped() const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Readings come up to so many frames late (Screen::kLongestDelay, and one that is being judged).
  static constexpr std::size_t kSettling = 16;

  void take_rows(const Delivery& delivery) MPM_REQUIRES(mutex_);
  void take_reading(std::int64_t interval, std::span<const float> readings) MPM_REQUIRES(mutex_);
  void take_digest(const history::Digest& digest) MPM_REQUIRES(mutex_);
  void measure_rate(std::size_t rows, Clock::time_point now) MPM_REQUIRES(mutex_);

  config::UnitConfig config_;
  FeedColumns columns_;
  RecentEvents& events_;
  mutable Mutex mutex_;
  History history_ MPM_GUARDED_BY(mutex_);
  History kpi_ MPM_GUARDED_BY(mutex_);
  std::deque<std::int64_t> intervals_ MPM_GUARDED_BY(mutex_);  // of the rows that may be amended
  std::vector<float> row_ MPM_GUARDED_BY(mutex_);
  std::vector<ResidualBand> bands_ MPM_GUARDED_BY(mutex_);
  std::shared_ptr<const UnitSnapshot> snapshot_ MPM_GUARDED_BY(mutex_);
  std::optional<live::DiagnosisOutcome> diagnosis_ MPM_GUARDED_BY(mutex_);
  std::optional<Clock::time_point> rate_since_ MPM_GUARDED_BY(mutex_);
  std::size_t rate_rows_ MPM_GUARDED_BY(mutex_) = 0;
  double rate_ MPM_GUARDED_BY(mutex_) = 0.0;
  std::uint64_t dropped_ MPM_GUARDED_BY(mutex_) = 0;
};

/// 1 - error of the predictions / error of who predicts no change, of 0..1, mean over the CVs; NaN
/// where none can be told.
[[nodiscard]] double model_accuracy(const history::Digest& digest);
/// Share of the channels with a verdict, 0..1; NaN where there is no channel.
[[nodiscard]] double determined_share(const history::Digest& digest);

}  // namespace mpm::http
