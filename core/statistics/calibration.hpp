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

}  // namespace mpm
