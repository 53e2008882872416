#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

/// Numbers that decide what a historian is accused of (compression.hpp, historian.hpp).
namespace mpm {

// Chosen by hand from what they mean; the rates that they give are in compression_test.cpp and
// historian_test.cpp.
namespace compression {
/// Changes in a batch; where they are rare so many are enough, once so many values have come.
inline constexpr int kChanges = 200;
inline constexpr int kFewestChanges = 30;
inline constexpr int kMostValues = 1000;
/// Held: so many changes follow a rest, fewer than this share of them are small beside the median
/// one (of normal changes 13 % are, of the wider measure for few changes 26 %; after a deadband,
/// which is coarse where changes are rare, none), fewer are the smallest there is, and their sizes
/// are no fewer than so many. Of a sensor whose resolution is a third of its noise or more a sixth
/// of the changes or more are the smallest, and a seventh follow a rest. A test signal has a few
/// sizes.
inline constexpr double kRested = 0.1;
inline constexpr double kSmallMove = 0.25;
inline constexpr double kSmallOfRare = 0.5;
inline constexpr double kFewSmall = 0.02;
inline constexpr double kFewResolved = 0.03;
inline constexpr int kFewestSizes = 4;
/// A change is the smallest below so many times it; changes are the same size within this share of
/// it: between one step and two; what printing leaves of a few digits.
inline constexpr double kOneStep = 1.5;
inline constexpr double kSame = 1e-3;
/// Interpolated: two changes in a row are one line where they differ by less than this share, and a
/// bend where by more than that: what single precision leaves of a line; what no slow answer does
/// in a sample. So many changes go straight on, and so many end a line; where most are straight one
/// is enough.
inline constexpr double kStraight = 1e-3;
inline constexpr double kBend = 0.2;
inline constexpr double kStraightShare = 0.15;
inline constexpr double kBends = 0.015;
inline constexpr double kMostlyStraight = 0.5;
}  // namespace compression

/// What is read every so many rows (an analyser). Chosen: a deadband's holds are of all lengths.
namespace readings {
inline constexpr std::size_t kFewest = 20;
inline constexpr double kRegular = 0.9;         ///< share of the spacings
inline constexpr Eigen::Index kJitterFrom = 8;  ///< rows: the cycle need be no multiple of one
/// Rows from the line through all of them, beyond which one is no reading.
inline constexpr double kOffLine = 2.0;
/// While readings come (`ReadingCycle`): spacings that are remembered, the share of them that still
/// is a cycle once it was one, and the longest that is looked for, samples.
inline constexpr std::size_t kRemembered = 31;
inline constexpr double kStillRegular = 0.5;
inline constexpr double kLongest = 1e4;
/// Between two intervals, which are within 2^53 either way.
inline constexpr std::int64_t kFarthest = std::int64_t{1} << 54;
}  // namespace readings

inline constexpr std::size_t kFewestRows = 100;
inline constexpr std::size_t kFewestSteps = 30;  ///< that a quantum can be told from
inline constexpr double kHeldShare = 0.3;        ///< of the rows
inline constexpr std::size_t kFewestLevels = 5;  ///< of a converter; a test signal has fewer
inline constexpr double kNeighbours = 0.8;       ///< share of the moves that are of one quantum
inline constexpr double kOfLattice = 1e-3;  ///< a multiple is one to within this share of a quantum
inline constexpr double kTie = 1e-9;        ///< of the range: values that differ by less are one
inline constexpr double kOneQuantum = 1.5;  ///< quanta: moves below are of one
inline constexpr double kMuch = 0.5;        ///< of the signal's s.d., of the rows

/// Whether a signal reads an input back (readback.hpp).
namespace readback {
/// Of the signal's own past, and of each input. Chosen: a control loop below answers within.
inline constexpr int kLags = 5;
/// Of what the signal's own past leaves. Chosen: of the recovery boiler's measured flows,
/// temperature and valve position their set-points explain all, of its liquor's solids 0.3 %.
inline constexpr double kMostOf = 0.5;
inline constexpr int kRowsPerColumn = 10;  ///< chosen
/// Rows that the monitor looks at. Chosen: it asks in between two samples, of every signal.
inline constexpr int kMostRowsLive = 1000;
}  // namespace readback

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
