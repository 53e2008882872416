#include "core/statistics/reading_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/archive/archive.hpp"
#include "core/statistics/reading_spacings.hpp"

namespace mpm {

std::optional<ReadingCycle::Reading> ReadingCycle::take(std::int64_t interval, double value) {
  if (!std::isfinite(value)) return std::nullopt;
  const bool first = !std::isfinite(last_), changed = !first && value != last_;
  const auto now = static_cast<double>(interval);
  if (changed) {
    spacings_[next_] = interval - changed_;
    next_ = (next_ + 1) % spacings_.size();
    count_ = std::min(count_ + 1, spacings_.size());
  }
  if (first || changed) {
    last_ = value;
    changed_ = interval;
  }
  if (changed) look_at_spacings();
  if (samples_ == 0.0) {
    if (first || changed) read_ = now;
    assumed_ = 0;
    return std::nullopt;
  }
  const double cycles = (now - read_) / samples_;
  if (changed) {
    const auto since = static_cast<std::int64_t>(std::round(cycles)) - assumed_;
    read_ = now;
    assumed_ = 0;
    if (since < 1) return std::nullopt;  // between two readings: none of the analyser's
    return Reading{value, since};
  }
  // The next reading is there, and no other than the last; it may have come a sample late.
  const auto since = static_cast<std::int64_t>(std::floor(cycles - 1.0 / samples_)) - assumed_;
  if (since < 1) return std::nullopt;
  assumed_ += since;
  return Reading{value, since};
}

void ReadingCycle::look_at_spacings() {
  if (count_ < readings::kFewest) return;
  auto spacings = spacings_;
  const ReadingSpacings found = reading_spacings(std::span(spacings).first(count_));
  const bool reads = samples_ > 0.0;
  if (found.regular < (reads ? readings::kStillRegular : readings::kRegular) ||
      found.mean > readings::kLongest)
    samples_ = 0.0;
  else if (!reads || std::abs(found.mean - samples_) > 1.0)
    samples_ = found.mean;
}

void ReadingCycle::archive(Archive& a) {
  for (std::int64_t& spacing : spacings_) a.within(spacing, 0, readings::kFarthest);
  a(last_, changed_, samples_, read_, assumed_);
  a.require(std::abs(read_) <= static_cast<double>(readings::kFarthest),
            "a reading beyond all intervals");
  a.within(count_, 0, spacings_.size());
  a.within(next_, 0, spacings_.size() - 1);
  a.require(samples_ == 0.0 || (samples_ > 1.0 && samples_ <= readings::kLongest),
            "a cycle beyond its limits");
}

}  // namespace mpm
