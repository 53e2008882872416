#pragma once

#include <cstdint>
#include <span>

namespace mpm {

/// What cycle readings keep to, by the rows from each to the next.
struct ReadingSpacings {
  std::int64_t every = 0;  ///< the median one; 0 where there is none
  double regular = 0.0;    ///< share of them that are of the cycle
  double mean = 0.0;       ///< rows in one cycle, by those that are
};

/// Two readings that are equal, and one that is missing, make a multiple. A cycle that is no whole
/// number of rows makes two lengths that follow each other, and a long one may come a row early or
/// late: whichever is enough. Reorders `spacings`.
[[nodiscard]] ReadingSpacings reading_spacings(std::span<std::int64_t> spacings);

}  // namespace mpm
