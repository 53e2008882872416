#pragma once

#include <cstddef>

/// Numbers that decide what a historian is accused of (historian.hpp).
namespace mpm {

// Chosen by hand from what they mean; the rates that they give are in historian_test.cpp.
inline constexpr std::size_t kFewestRows = 100;
inline constexpr std::size_t kFewestMoves = 30;  ///< that a smallest one can be told from
inline constexpr double kHeld = 0.3;             ///< share of the rows
/// The smallest move beside the median one: of 30 normal ones it is as large in 1 of 200 columns.
inline constexpr double kSmallestMove = 0.3;
/// Archived values hardly ever come again; levels of a test signal or of a converter do.
inline constexpr double kNewValues = 0.5;
inline constexpr std::size_t kFewestLevels = 5;  ///< of a converter; a test signal has fewer
inline constexpr double kNeighbours = 0.8;       ///< share of the moves that are of one quantum
inline constexpr double kOfLattice = 1e-3;  ///< a multiple is one to within this share of a quantum
/// A line is straight to within this share of the range, and a corner beyond a hundred times it.
inline constexpr double kStraight = 1e-7;
inline constexpr double kCorner = 100.0;
inline constexpr double kStraightShare = 0.5;
inline constexpr double kBetween =
    0.05;  ///< share of the rows that are neither; a smooth signal has many
inline constexpr std::size_t kFewestCorners = 20;
inline constexpr double kTie = 1e-9;        ///< of the range: values that differ by less are one
inline constexpr double kOneQuantum = 1.5;  ///< quanta: moves below are of one
inline constexpr double kMuch = 0.5;        ///< of the signal's s.d., of the rows

/// Whether a series of values changed (level_change.hpp).
namespace level_change {
/// Fewer tell no change from scatter: the p-value of a step ten times the scatter is 0.01. Chosen.
inline constexpr std::size_t kFewestPoints = 6;
/// A correlation of neighbours r about a fitted level and slope comes out lower by (2 + 4 r) / n on
/// average. Derived, to the order of 1 / n (Kendall 1954), for a mean and one slope.
inline constexpr double kLostPoints = 2.0;
inline constexpr double kLostShare = 4.0;
/// Of what resembles itself more nothing is believed that has fewer than twenty times the points.
inline constexpr double kMostResemblance = 0.9;
/// Degrees of freedom of a s.d. that is known.
inline constexpr double kKnown = 1e6;
}  // namespace level_change

}  // namespace mpm
