#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/text/words.hpp"
#include "daemon/files/times/time_zone.hpp"
#include "daemon/history/digest.hpp"
#include "daemon/history/read_journal.hpp"

namespace mpm::history {

enum class Step : std::uint8_t { kHour, kDay, kWeek };

[[nodiscard]] constexpr auto words_of(Step) { return std::array{"hour", "day", "week"}; }

/// One CV in one period; NaN where too little is known.
struct CvPeriod {
  double known = 0.0;  ///< share of the samples with a residual, 0..1
  double residual_rms = kUnknown, prediction_rms = kUnknown, movement_rms = kUnknown;
  double deviation = kUnknown;  ///< s.d. of ln prediction_rms, from how the digests scatter

  /// Of the movement over the horizon, how much the predictions get right, in %: 100 is all of it,
  /// 0 no more than a prediction that nothing moves.
  [[nodiscard]] double fit() const { return 100.0 * (1.0 - prediction_rms / movement_rms); }
};

/// One channel in one period.
struct ChannelPeriod {
  double match = 0.0, mismatch = 0.0, undetermined = 0.0;  ///< shares of the samples, sum 1
  double excited = 0.0;                                    ///< share of the samples
  /// Means over the time in which they were determined, units as in ChannelDigest; NaN where that
  /// was too short.
  double gain_error = kUnknown, low = kUnknown, high = kUnknown;
  /// S.d. of the mean, as of values that tell nothing of each other: those of neighbouring periods
  /// that one memory spans do, and it is larger by as much.
  double deviation = kUnknown;
};

struct Period {
  std::int64_t index = 0;                  ///< of hours, days or weeks of the clock of the data
  std::int64_t from_ns = 0, until_ns = 0;  ///< first and last sample
  std::int64_t samples = 0;
  std::vector<CvPeriod> cvs;
  std::vector<ChannelPeriod> channels;
};

/// How a unit's model fared, period by period. Vectors of CVs and channels as in the head.
struct Trend {
  UnitHead head;
  Step step = Step::kDay;
  bool dated = false;           ///< times are dates, not seconds since some beginning
  std::vector<Period> periods;  ///< without those that have no sample
  std::vector<AlarmChangeNote> alarms;
  std::vector<ChannelDigest> last;  ///< of each, after the last sample

  [[nodiscard]] std::int64_t samples() const;
  [[nodiscard]] bool mismatch() const;
};

/// A trend of digests and alarms as they come.
class TrendMaker {
 public:
  /// `step`: none = by the length of the history. `zone`: whose hours and days; null = UTC.
  TrendMaker(std::optional<Step> step, const files::TimeZone* zone) : step_(step), zone_(zone) {}

  /// Channels and CVs are those of the last head.
  void add(UnitHead head) { head_ = std::move(head); }
  /// One that begins as another did, with the same residuals, is the same again (two runs over one
  /// file), and is left out; with others the clock was set back, and both count.
  void add(const Digest& digest);
  void add(AlarmChangeNote alarm) { alarms_.push_back(std::move(alarm)); }

  [[nodiscard]] Trend finish() const;

 private:
  /// Sums, which are added up for longer periods.
  struct CvSums {
    std::int64_t samples = 0, pairs = 0;
    double residual = 0.0, prediction = 0.0, movement = 0.0;  // squares
    double fourth = 0.0;  // of each digest its prediction error to the fourth, times its pairs
    void add(const CvSums& other);
  };
  struct ChannelSums {
    std::int64_t match = 0, mismatch = 0, excited = 0;
    double weight = 0.0;  // samples with a gain
    double error = 0.0, low = 0.0, high = 0.0, effective = 0.0;
    void add(const ChannelSums& other);
  };
  struct Sums {
    std::int64_t from_ns = 0, until_ns = 0, samples = 0;
    std::map<std::string, CvSums> cvs;
    std::map<std::pair<std::string, std::string>, ChannelSums> channels;  // mv, cv
    void add(const Sums& other);
  };

  [[nodiscard]] bool is_new(const Digest& digest);
  [[nodiscard]] Period period_of(std::int64_t index, const Sums& sums, Step step) const;

  std::optional<Step> step_;
  const files::TimeZone* zone_;
  UnitHead head_;
  std::set<std::vector<double>> seen_;  // when they began, and their residuals
  std::map<std::int64_t, Sums> hours_;  // by hour of the clock
  std::int64_t last_ns_ = 0;
  std::vector<ChannelDigest> last_;
  std::vector<AlarmChangeNote> alarms_;
};

/// "14:00 on 3 March", "3 March", "week 10 (from 2 March)"; "hour 3", "day 1", "week 2" where times
/// are no dates. With the year where it is not that of the last period.
[[nodiscard]] std::string period_name(const Trend& trend, std::size_t period);

}  // namespace mpm::history
