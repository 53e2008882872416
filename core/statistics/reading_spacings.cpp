#include "core/statistics/reading_spacings.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/statistics/calibration.hpp"

namespace mpm {
namespace {

/// Rows by which a spacing may be off the median one, and where `multiples` off a multiple of it:
/// of a short one they would be all there are.
struct Slack {
  std::int64_t below = 0, above = 0;
  bool multiples = true;
};

ReadingSpacings within(std::span<const std::int64_t> spacings, std::int64_t every,
                       const Slack& slack) {
  std::int64_t rows = 0, cycles = 0, regular = 0;
  for (const std::int64_t spacing : spacings) {
    const std::int64_t multiple = std::max<std::int64_t>(1, (spacing + (every - 1) / 2) / every);
    const std::int64_t off = spacing - multiple * every;
    const bool strict = multiple > 1 && !slack.multiples;
    if (strict ? off != 0 : off < -slack.below || off > slack.above) continue;
    ++regular;
    rows += spacing;
    cycles += multiple;
  }
  return {every, static_cast<double>(regular) / static_cast<double>(spacings.size()),
          cycles > 0 ? static_cast<double>(rows) / static_cast<double>(cycles) : 0.0};
}

}  // namespace

ReadingSpacings reading_spacings(std::span<std::int64_t> spacings) {
  if (spacings.empty()) return {};
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  const std::int64_t every = *middle;
  if (every < 2) return {every, 0.0, 0.0};
  // Of 2 and 1 the shorter one is no cycle.
  const std::int64_t early = every > 2 ? 1 : 0;
  const std::int64_t jitter = every >= readings::kJitterFrom ? 1 : 0;
  ReadingSpacings best;
  for (const Slack& slack :
       {Slack{0, 0}, Slack{0, 1, false}, Slack{early, 0, false}, Slack{jitter, jitter}}) {
    const ReadingSpacings found = within(spacings, every, slack);
    if (found.regular <= best.regular) continue;
    best = found;
    if (best.regular >= readings::kRegular) break;
  }
  return best;
}

}  // namespace mpm
