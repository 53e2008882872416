#include "daemon/bus/input_stream.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/signal/calibration.hpp"

namespace mpm::bus {
namespace {

// Source times that are off by less are jitter: controllers are not held to the second.
constexpr double kSmallestClockStepS = 60.0;
constexpr double kClockStepSamples = 10.0;
// Beyond this distance nothing was left out: another counter.
constexpr std::int64_t kFar = 100'000;
// As far as a number goes back when samples come in another order (core/signal/aligner).
constexpr std::int64_t kReordered = 32;

}  // namespace

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

void InputStream::push(const Arrival& arrival, double sample_time_s, Clock::time_point now) {
  newest_ = arrival;
  last_ = now;
  Writer& writer = writer_of(arrival.writer, now);
  if (writer.samples > 0) {
    // Numbers may be anything: no difference of extremes.
    const double steps =
        static_cast<double>(arrival.interval) - static_cast<double>(writer.interval);
    writer.standing = steps == 0.0 ? writer.standing + 1 : 0;
    if (steps == 0.0) ++writer.repeated;
    if (steps > 1.0 && steps < static_cast<double>(kFar))
      writer.skipped += static_cast<std::uint64_t>(steps) - 1;
    // As for core/signal/aligner: what is late is older than what came before it.
    const bool newer = arrival.source_time_ns > writer.source_time_ns;
    const bool back =
        steps < -static_cast<double>(kReordered) ||
        (newer && steps <= -static_cast<double>(calibration::alignment::kSmallestReturn));
    if (steps > static_cast<double>(kJump) || back)
      jump_ = Jump{now, writer.interval, arrival.interval};
    const double elapsed_s = 1e-9 * (static_cast<double>(arrival.source_time_ns) -
                                     static_cast<double>(writer.source_time_ns));
    const double step_s = elapsed_s - steps * sample_time_s;
    const bool dated = arrival.source_time_ns != writer.source_time_ns;  // else it has no clock
    // A counter that jumps says nothing of the clock.
    if (dated && steps > 0.0 && steps <= static_cast<double>(kJump) &&
        std::abs(step_s) > std::max(kSmallestClockStepS, kClockStepSamples * sample_time_s))
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

std::pair<const InputStream::Writer*, const InputStream::Writer*> InputStream::rivals(
    Clock::time_point now, Clock::duration recently) const {
  for (const Writer& a : writers_) {
    if (a.samples == 0 || now - a.last > recently) continue;
    for (const Writer& b : writers_) {
      if (&a == &b || b.samples == 0 || now - b.last > recently) continue;
      // Where one took over from the other the first had ended before the second began.
      if (a.first <= b.first && a.last > b.first) return {&a, &b};
    }
  }
  return {nullptr, nullptr};
}

}  // namespace mpm::bus
