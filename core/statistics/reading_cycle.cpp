#include "core/statistics/reading_cycle.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"

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
  // The next reading is there, and no other than the last.
  const double late = samples_ < static_cast<double>(readings::kJitterFrom) ? 0.0 : 1.0 / samples_;
  const std::int64_t since = static_cast<std::int64_t>(std::floor(cycles - late)) - assumed_;
  if (since < 1) return std::nullopt;
  assumed_ += since;
  return Reading{value, since};
}

void ReadingCycle::look_at_spacings() {
  if (count_ < readings::kFewest) return;
  auto sorted = spacings_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
  const std::int64_t every = *middle;
  const std::int64_t jitter = every >= readings::kJitterFrom ? 1 : 0;
  std::int64_t rows = 0, cycles = 0;
  std::size_t regular = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const std::int64_t multiple = std::max<std::int64_t>(1, (spacings_[i] + every / 2) / every);
    if (std::abs(spacings_[i] - multiple * every) > jitter) continue;
    ++regular;
    rows += spacings_[i];
    cycles += multiple;
  }
  const double share = static_cast<double>(regular) / static_cast<double>(count_);
  const bool reads = samples_ > 0.0;
  if (every < 2 || static_cast<double>(every) >= readings::kLongest ||
      share < (reads ? readings::kStillRegular : readings::kRegular)) {
    samples_ = 0.0;
    return;
  }
  const double found = static_cast<double>(rows) / static_cast<double>(cycles);
  if (!reads || std::abs(found - samples_) > static_cast<double>(std::max<std::int64_t>(1, jitter)))
    samples_ = found;
}

void ReadingCycle::archive(Archive& a) {
  a(spacings_, last_, changed_, samples_, read_, assumed_);
  a.within(count_, 0, spacings_.size());
  a.within(next_, 0, spacings_.size() - 1);
  a.require(samples_ == 0.0 || (samples_ > 1.0 && samples_ <= readings::kLongest + 1.0),
            "a cycle beyond its limits");
}

}  // namespace mpm
