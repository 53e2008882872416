#include "daemon/bus/input_stream.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/signal/calibration.hpp"

namespace mpm::bus {
namespace {

// Source times that are off by less are jitter: controllers are not held to the second.
constexpr double kSmallestClockStepS = 60.0;
constexpr double kClockStepSamples = 10.0;
// A clock runs as this machine's where its offset stays the same for so long, but for so much.
constexpr std::chrono::seconds kSteady{10};
constexpr double kSteadySamples = 3.0;
constexpr double kUnsteadyS = 1.0;
constexpr double kUnsteadySamples = 0.1;
// Beyond this distance nothing was left out: another counter.
constexpr std::int64_t kFar = 100'000;
// As far as a number goes back when samples come in another order (core/signal/aligner).
constexpr std::int64_t kReordered = 32;
// Of the last intervals, from which on left out ones are told.
constexpr int kFewestLeftOut = 2;
constexpr int kLeftOutInverseShare = 16;
// A step of source times is odd where it is off by this factor; so many it takes, and three of four
// of them odd, until the pace is. What stalls or steps once is not.
constexpr double kOddPace = 1.5;
constexpr int kFewestSteps = 8;

// Whether the number went back to a new beginning; as for core/signal/aligner: what is late is
// older than what came before it. `steps`: to this sample.
bool goes_back(double steps, bool newer) {
  return steps < -static_cast<double>(kReordered) ||
         (newer && steps <= -static_cast<double>(calibration::alignment::kSmallestReturn));
}

double elapsed_s(std::int64_t from_ns, const Arrival& to) {
  return 1e-9 * (static_cast<double>(to.source_time_ns) - static_cast<double>(from_ns));
}

// Whether the source time went on as far as the numbers.
bool is_timely(double steps, double elapsed_s, double sample_time_s) {
  const double usual_s = steps * sample_time_s;
  return steps > 0.0 && elapsed_s < kOddPace * usual_s && elapsed_s * kOddPace > usual_s;
}

}  // namespace

double clock_limit_s(double sample_time_s) {
  return std::max(kSmallestClockStepS, kClockStepSamples * sample_time_s);
}

std::optional<double> InputStream::clock_offset_s(double sample_time_s) const {
  if (!offset_ || !last_) return std::nullopt;
  const std::chrono::duration<double> steady = *last_ - offset_->since;
  if (steady < kSteady || steady.count() < kSteadySamples * sample_time_s) return std::nullopt;
  return offset_->s;
}

void InputStream::follow_clock(const Arrival& arrival, double sample_time_s,
                               Clock::time_point now) {
  if (arrival.wall_ns == 0) return;
  const double s =
      1e-9 * (static_cast<double>(arrival.source_time_ns) - static_cast<double>(arrival.wall_ns));
  if (!offset_ || std::abs(s - offset_->s) > kUnsteadyS + kUnsteadySamples * sample_time_s)
    offset_ = Offset{s, now};
}

int InputStream::Recent::left_out() const { return intervals - std::popcount(came); }

bool InputStream::Recent::with_gaps() const {
  return left_out() >= kFewestLeftOut && left_out() * kLeftOutInverseShare >= intervals;
}

bool InputStream::Recent::off_pace() const {
  return steps >= kFewestSteps && 4 * std::popcount(odd) >= 3 * steps;
}

void InputStream::remember(const Arrival& arrival, double sample_time_s) {
  Recent& r = recent_;
  // Numbers may be anything: no difference of extremes.
  const double ahead = static_cast<double>(arrival.interval) - static_cast<double>(r.newest);
  const bool newer = arrival.source_time_ns > r.newest_time_ns;
  if (r.intervals == 0 || ahead > static_cast<double>(kJump) || goes_back(ahead, newer)) {
    r = {};
    r.newest = r.dated = arrival.interval;
    r.newest_time_ns = r.dated_ns = arrival.source_time_ns;
    r.intervals = 1;
    r.came = 1;
    return;
  }
  const int steps = static_cast<int>(ahead);
  if (steps <= 0) {
    if (-steps < r.intervals) r.came |= std::uint64_t{1} << -steps;
    return;
  }
  r.came = r.came << steps | 1;
  r.intervals = std::min(Recent::kMost, r.intervals + steps);
  r.newest = arrival.interval;
  r.newest_time_ns = arrival.source_time_ns;
  if (arrival.source_time_ns == r.dated_ns) return;
  const double elapsed_s =
      1e-9 * (static_cast<double>(arrival.source_time_ns) - static_cast<double>(r.dated_ns));
  const double each_s = elapsed_s / static_cast<double>(arrival.interval - r.dated);
  const bool odd = each_s > kOddPace * sample_time_s || each_s * kOddPace < sample_time_s;
  r.odd = r.odd << 1 | (odd ? 1 : 0);
  r.steps = std::min(Recent::kMost, r.steps + 1);
  if (odd) r.time_per_interval_s = each_s;
  r.dated = arrival.interval;
  r.dated_ns = arrival.source_time_ns;
}

InputStream::Writer& InputStream::writer_of(std::uint64_t handle, Clock::time_point now) {
  for (Writer& writer : writers_)
    if (writer.samples > 0 && writer.handle == handle) return writer;
  Writer& place =
      *std::min_element(writers_.begin(), writers_.end(), [](const auto& a, const auto& b) {
        if ((a.samples == 0) != (b.samples == 0)) return a.samples == 0;
        return a.last < b.last;
      });
  place = {};
  place.handle = handle;
  place.first = now;
  return place;
}

// Who takes over from one that has left goes on where that ended, or leaps as that one might. A
// beginning at lower numbers is a restart, and no leap.
void InputStream::begin(const Arrival& arrival, double sample_time_s, Clock::time_point now) {
  const Writer* before = nullptr;
  for (const Writer& other : writers_)
    if (other.samples > 0 && (before == nullptr || other.last > before->last)) before = &other;
  if (before == nullptr) return;
  const double steps =
      static_cast<double>(arrival.interval) - static_cast<double>(before->interval);
  if (steps <= static_cast<double>(kJump)) return;
  jump_ =
      Jump{.when = now,
           .from = before->interval,
           .to = arrival.interval,
           .timely = is_timely(steps, elapsed_s(before->source_time_ns, arrival), sample_time_s),
           .before = before->handle,
           .to_ns = arrival.source_time_ns};
}

void InputStream::push(const Arrival& arrival, double sample_time_s, Clock::time_point now) {
  beyond_ = arrival.interval > calibration::alignment::kLargestInterval ||
            arrival.interval < -calibration::alignment::kLargestInterval;
  last_ = now;
  if (beyond_) {  // the numbers that were taken stand
    newest_ = arrival;
    return;
  }
  Writer& writer = writer_of(arrival.writer, now);
  if (writer.samples == 0) begin(arrival, sample_time_s, now);
  newest_ = arrival;
  remember(arrival, sample_time_s);
  follow_clock(arrival, sample_time_s, now);
  if (writer.samples > 0) {
    // Numbers may be anything: no difference of extremes.
    const double steps =
        static_cast<double>(arrival.interval) - static_cast<double>(writer.interval);
    writer.standing = steps == 0.0 ? writer.standing + 1 : 0;
    if (steps == 0.0) ++writer.repeated;
    if (steps > 1.0 && steps < static_cast<double>(kFar))
      writer.skipped += static_cast<std::uint64_t>(steps) - 1;
    const bool back = goes_back(steps, arrival.source_time_ns > writer.source_time_ns);
    const double elapsed = elapsed_s(writer.source_time_ns, arrival);
    if (steps > static_cast<double>(kJump) || back)
      jump_ = Jump{.when = now,
                   .from = writer.interval,
                   .to = arrival.interval,
                   .timely = is_timely(steps, elapsed, sample_time_s),
                   .to_ns = arrival.source_time_ns};
    const double step_s = elapsed - steps * sample_time_s;
    const bool dated = arrival.source_time_ns != writer.source_time_ns;  // else it has no clock
    const double limit_s = clock_limit_s(sample_time_s);
    // Where as much time went by here, the control system stood still and its clock is right.
    const double here_s = std::chrono::duration<double>(now - writer.last).count();
    // A counter that jumps says nothing of the clock.
    if (dated && steps > 0.0 && steps <= static_cast<double>(kJump) && std::abs(step_s) > limit_s &&
        std::abs(elapsed - here_s) > limit_s)
      clock_step_ = ClockStep{now, arrival.interval, step_s};
    if (steps < 0.0 && !back) {  // late: the newer one stays
      ++writer.samples;
      writer.last = now;
      return;
    }
  }
  ++writer.samples;
  writer.last = now;
  writer.interval = arrival.interval;
  writer.source_time_ns = arrival.source_time_ns;
}

std::optional<InputStream::Jump> InputStream::jump() const {
  const bool both_write =
      jump_ && jump_->before != 0 &&
      std::any_of(writers_.begin(), writers_.end(), [this](const Writer& writer) {
        return writer.samples > 0 && writer.handle == jump_->before && writer.last > jump_->when;
      });
  return both_write ? std::nullopt : jump_;
}

}  // namespace mpm::bus
