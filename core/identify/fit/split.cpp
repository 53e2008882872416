#include "core/identify/fit/split.hpp"

#include <cmath>

#include "core/identify/fit/calibration.hpp"

namespace mpm {

using Eigen::Index;

Index fitted_rows(const Recording& recording, double share) {
  const double wanted = share * static_cast<double>(recording.samples());
  auto rows = static_cast<Index>(wanted);
  const Index changed = recording.changed.value_or(rows);
  const auto since = static_cast<double>(recording.samples() - changed);
  if (recording.borders.empty() && recording.changed &&
      static_cast<double>(changed) <= (1.0 + kJustBehind) * static_cast<double>(rows))
    return changed + static_cast<Index>(share * since);
  if (recording.borders.size() < 2) return rows;
  double nearest = kFarBorder * static_cast<double>(recording.samples());
  for (const Border& border : recording.borders) {
    const double away = std::abs(static_cast<double>(border.row) - wanted);
    if (away <= nearest) nearest = away, rows = border.row;
  }
  return rows;
}

}  // namespace mpm
