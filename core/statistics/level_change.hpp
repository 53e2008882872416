#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace mpm {

/// One value of a series, such as the mean of a week.
struct LevelPoint {
  double at = 0.0;  ///< time, in any unit
  double value = 0.0;
  double deviation = 0.0;  ///< s.d. of the value, if nothing but chance moves it; 0 = not known
};

/// How a series changed: from one level to another at once, or from a level on along a line.
struct LevelChange {
  bool gradual = false;
  std::size_t first =
      0;                ///< point: the first one after the change, or the last one before the line
  double before = 0.0;  ///< the level before it
  double after = 0.0;   ///< the level after it; of a line where it ends
  double deviation = 0.0;  ///< s.d. of after - before
  double p_value = 1.0;    ///< of one constant level
};

/// The likeliest change of a series of at least level_change::kFewestPoints points in the order of
/// time; nothing where they are fewer. Each step and each bend is fitted by weighted least squares
/// and must beat one constant level by more than the deviations given, or by more than the scatter
/// that it leaves where that is larger or they are not known. The p-value is that of the F test,
/// times the number of steps and bends tried. Scatter whose neighbours resemble each other counts
/// for as many fewer points.
[[nodiscard]] std::optional<LevelChange> find_level_change(std::span<const LevelPoint> points);

}  // namespace mpm
