#pragma once

#include <Eigen/Core>

#include "core/identify/fit/recording.hpp"

namespace mpm {

/// Rows at the beginning of a recording that are fitted; the rest is left to measure the gain on.
/// `share` of the rows (0..1), rounded down. Of three runs or more the last are left out whole, so
/// that what is measured is another occasion: the border nearest to that share, unless none is near
/// (runs that are so unlike in length are cut as one would be).
/// Where something changed within them or just behind, what came after it is parted by that share:
/// else few rows would know it, or none.
[[nodiscard]] Eigen::Index fitted_rows(const Recording& recording, double share);

}  // namespace mpm
