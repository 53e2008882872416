#include "daemon/files/csv/held_rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/signal/nanoseconds.hpp"

namespace mpm::files {
namespace {

constexpr double kJitter = 0.1;  // of a step, that a row may come too late
constexpr double kLongestSilenceSeconds =
    3600.0;  // historians write more often even if nothing changes
constexpr double kLongestSilenceSteps = 100.0;  // control intervals, if that is longer
constexpr double kMostHeldSteps = 1e6;          // never more of them

}  // namespace

HeldRows::HeldRows(std::unique_ptr<RowSource> rows, const SignalCounts& counts, double step_s,
                   double sample_time_s)
    : rows_(std::move(rows)),
      step_ns_(step_s * kNsPerSecond),
      silence_ns_(std::clamp(kLongestSilenceSeconds, kLongestSilenceSteps * sample_time_s,
                             kMostHeldSteps * sample_time_s) *
                  kNsPerSecond) {
  clear(held_, counts);
  read();
  begin_ns_ = last_ns_ = coming_.source_time_ns;
}

bool HeldRows::next(Frame& frame) {
  if (!there_) return false;  // all of them are in rows that were given
  if (static_cast<double>(coming_.source_time_ns - last_ns_) > silence_ns_ &&
      time_ns() > last_ns_) {
    const auto steps = static_cast<double>(coming_.source_time_ns - begin_ns_) / step_ns_;
    at_ = std::max(at_, static_cast<std::int64_t>(std::ceil(steps - kJitter)));
  }
  const double until_ns = static_cast<double>(time_ns()) + kJitter * step_ns_;
  while (there_ && static_cast<double>(coming_.source_time_ns) <= until_ns) take();
  frame = held_;
  frame.source_time_ns = time_ns();
  for (const Line& line : lines_) {
    const auto length = static_cast<double>(line.to.time_ns - line.from_ns);
    const double share = static_cast<double>(frame.source_time_ns - line.from_ns) / length;
    frame[line.slot.kind].values(line.slot.index) =
        line.from + std::clamp(share, 0.0, 1.0) * (line.to.value - line.from);
  }
  ++at_;
  return true;
}

std::string HeldRows::notice() const {
  return rows_->has_lines()
             ? "each tag has times of its own: MVs and set-points are held until the next one, all "
               "others are on the line to it, as a compressing historian means them; so they may "
               "move before what moves them"
             : "each tag has times of its own: its values are held from one to the next, so that "
               "none is used before its time";
}

void HeldRows::read() { there_ = rows_->next(coming_); }

void HeldRows::take() {
  const Told& told = *rows_->told();
  for (std::size_t kind = 0; kind < kSignalKindCount; ++kind)
    for (std::size_t i = 0; i < told[kind].size(); ++i) {
      if (!told[kind][i]) continue;
      const auto index = static_cast<Eigen::Index>(i);
      held_.blocks[kind].values(index) = coming_.blocks[kind].values(index);
      held_.blocks[kind].quality[i] = coming_.blocks[kind].quality[i];
      const Slot slot{static_cast<SignalKind>(kind), static_cast<int>(i)};
      lines_.erase(std::remove_if(lines_.begin(), lines_.end(),
                                  [&slot](const Line& line) {
                                    return line.slot.kind == slot.kind &&
                                           line.slot.index == slot.index;
                                  }),
                   lines_.end());
      const double from = held_.blocks[kind].values(index);
      const std::optional<Next> to = rows_->next_of(slot.kind, i);
      if (to && std::isfinite(from) && held_.blocks[kind].quality[i] != Quality::kBad &&
          to->time_ns > coming_.source_time_ns)
        lines_.push_back({slot, coming_.source_time_ns, from, *to});
    }
  last_ns_ = std::max(last_ns_, coming_.source_time_ns);
  read();
}

std::int64_t HeldRows::time_ns() const {
  return begin_ns_ + std::llround(static_cast<double>(at_) * step_ns_);
}

}  // namespace mpm::files
