#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace mpm::bus {

/// A sample of an input, as far as it tells how the data come.
struct Arrival {
  std::uint64_t writer = 0;  ///< as in idl::SampleInfo
  std::int64_t interval = 0;
  std::int64_t source_time_ns = 0;
  std::size_t values = 0;     ///< how many it has
  std::size_t qualities = 0;  ///< 0 = all good
  std::int64_t wall_ns = 0;   ///< when it came, UTC; 0: not known
};

/// Source times that are off by more are told.
[[nodiscard]] double clock_limit_s(double sample_time_s);

/// One topic of one unit as it arrives. Remembers a few numbers per writer, whatever comes.
class InputStream {
 public:
  using Clock = std::chrono::steady_clock;

  /// What one writer sent.
  struct Writer {
    std::uint64_t handle = 0;
    Clock::time_point first{}, last{};
    std::int64_t interval = 0;  ///< the last one
    std::int64_t source_time_ns = 0;
    std::uint64_t samples = 0;   ///< 0: nobody is in this place
    std::uint64_t standing = 0;  ///< samples in a row that did not count on
    std::uint64_t repeated = 0;  ///< samples of the interval of the one before
    std::uint64_t skipped = 0;   ///< intervals left out
  };
  /// The interval number left out many, or went back.
  struct Jump {
    Clock::time_point when;
    std::int64_t from = 0, to = 0;
    bool timely = false;       ///< the source time went on as far: nothing was sent, or it was lost
    std::uint64_t before = 0;  ///< the writer that sent `from`, where it was another one
    std::int64_t to_ns = 0;    ///< source time of `to`
  };
  /// The source time did not go on with the interval number.
  struct ClockStep {
    Clock::time_point when;
    std::int64_t interval = 0;
    double size_s = 0.0;
  };

  /// How the last intervals came, whoever sent them.
  struct Recent {
    static constexpr int kMost = 64;
    std::int64_t newest = 0;
    std::int64_t newest_time_ns = 0;
    int intervals = 0;       ///< up to the newest one; 0: nothing has come
    std::uint64_t came = 0;  ///< bit i: `newest` - i
    /// Steps from one source time to the next; a bit is set where the time per interval was far
    /// from the sample time.
    int steps = 0;
    std::uint64_t odd = 0;
    double time_per_interval_s = 0.0;  ///< of the last of these
    std::int64_t dated = 0;            ///< interval with the last source time
    std::int64_t dated_ns = 0;

    [[nodiscard]] int left_out() const;
    /// So many are left out that the unit's statistics suffer.
    [[nodiscard]] bool with_gaps() const;
    /// The source times go on with the intervals, and not as the sample time says.
    [[nodiscard]] bool off_pace() const;
  };

  /// A jump leaves out at least so many intervals.
  static constexpr std::int64_t kJump = 10;
  static constexpr std::size_t kMostWriters = 4;

  void push(const Arrival& arrival, double sample_time_s, Clock::time_point now);

  [[nodiscard]] const std::array<Writer, kMostWriters>& writers() const { return writers_; }
  [[nodiscard]] bool started() const { return last_.has_value(); }
  /// Of the last sample; nothing before the first one.
  [[nodiscard]] std::optional<Clock::time_point> last() const { return last_; }
  /// The last sample; valid if there was one.
  [[nodiscard]] const Arrival& newest() const { return newest_; }
  [[nodiscard]] const Recent& recent() const { return recent_; }
  /// The last one. Where another writer began with it, and the one before it goes on, none.
  [[nodiscard]] std::optional<Jump> jump() const;
  /// The last sample had an interval number that is not taken.
  [[nodiscard]] bool beyond() const { return beyond_; }
  [[nodiscard]] const std::optional<ClockStep>& clock_step() const { return clock_step_; }
  /// How far the source times are ahead of this machine's clock, where they have gone on with it
  /// for a while.
  [[nodiscard]] std::optional<double> clock_offset_s(double sample_time_s) const;
  /// Two writers that both sent something while the other did, and within the last `recently`; the
  /// one that came first is the first. Nulls if there is none. `is_there(handle)`: it has not left.
  template <class IsThere>
  [[nodiscard]] std::pair<const Writer*, const Writer*> rivals(Clock::time_point now,
                                                               Clock::duration recently,
                                                               IsThere&& is_there) const {
    for (const Writer& a : writers_) {
      if (a.samples == 0 || now - a.last > recently || !is_there(a.handle)) continue;
      for (const Writer& b : writers_) {
        if (&a == &b || b.samples == 0 || now - b.last > recently || !is_there(b.handle)) continue;
        // Where one took over from the other the first had ended before the second began.
        if (a.first <= b.first && a.last > b.first) return {&a, &b};
      }
    }
    return {nullptr, nullptr};
  }

 private:
  Writer& writer_of(std::uint64_t handle, Clock::time_point now);
  struct Offset {
    double s = 0.0;
    Clock::time_point since;
  };

  void remember(const Arrival& arrival, double sample_time_s);
  void follow_clock(const Arrival& arrival, double sample_time_s, Clock::time_point now);
  void begin(const Arrival& arrival, double sample_time_s, Clock::time_point now);

  std::array<Writer, kMostWriters> writers_;
  Arrival newest_;
  Recent recent_;
  std::optional<Clock::time_point> last_;
  bool beyond_ = false;
  std::optional<Jump> jump_;
  std::optional<ClockStep> clock_step_;
  std::optional<Offset> offset_;
};

}  // namespace mpm::bus
