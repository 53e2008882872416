#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/identify/fit/whitening.hpp"
#include "core/signal/calibration.hpp"

/// Numbers that decide what the data may be asked at all. Chosen by hand where nothing else is
/// said; what they give together is scored by `mpm_hidden` and tests/foreign.
namespace mpm {

/// A channel may be named wrong where the calibrated test of its match has at most this p-value; a
/// part of several channels where the smallest of them, times their number, has. Counted on loops
/// of another implementation: of 27 right findings 23 are kept, of 18 wrong ones none.
inline constexpr double kRejected = 0.05;

/// And where its error's being too small to matter has at most this. Chosen: some two s.d. beyond
/// what does not matter.
inline constexpr double kMayMatter = 0.05;

/// The test's regression is made smaller until so many rows stand behind each of its columns, and
/// no smaller than this.
inline constexpr double kTestRowsPerColumn = 6.0;
inline constexpr int kFewestLags = 2, kFewestResidualLags = 2;

/// Rows in which a change is looked for; of longer recordings none is dated. Chosen: a hundred
/// megabytes for ten inputs.
inline constexpr Eigen::Index kMostRemembered = 100'000;

/// Order of the joint autoregression of residuals and inputs that says where inputs move from, and
/// rows that each of its columns takes.
inline constexpr int kMovementOrder = 6;
inline constexpr double kMovementRowsPerColumn = 4.0;

/// Of a measured position, what is left beside where a valve that sticks would go to what is left
/// beside its command. Chosen: of the recovery boiler's valve that sticks, in three runs, it is a
/// twentieth to a seventh, of valves and loops that do as told more than nine tenths.
inline constexpr double kMostOfPosition = 0.5;
/// A position of which the command explains less than the rest of this is another's. Chosen.
inline constexpr double kHardlyTold = 0.95;
/// Rows that are looked at, from the first on. Chosen: a valve and its position take a tenth of a
/// second.
inline constexpr Eigen::Index kMostRowsOfValve = 10'000;
/// How far a command may go while the valve rests, as shares of what it covers but for its tails:
/// the least that is tried, and each next one wider by this; how far the valve stays behind it when
/// it slips, as shares of that; then so many steps of both to either side of the best, each this
/// share of it. Chosen.
inline constexpr double kTailOfCommands = 0.025, kLeastRest = 0.01, kWider = 1.15;
inline constexpr double kSlips[] = {0.0, 0.2, 0.4, 0.6, 0.8};
inline constexpr double kReaches[] = {0.03, 0.01, 0.003, 0.001};
inline constexpr int kSteps = 4;

/// Rows of a run that are mirrored at either end where its first and last values are judged: enough
/// for the screen to know a signal. What an instrument makes up lasts no longer; a test's pulse
/// does. Chosen.
inline constexpr Eigen::Index kMirrored = 2 * calibration::extent::kFirstValues;
inline constexpr Eigen::Index kLongestGlitch = 2;  ///< rows
/// Of a signal that is elsewhere for long: at most so many of its rows at either end, and so many
/// ranges of the others away. Chosen: bar in place of Pa is 1e5 times its level, and no step of a
/// test is so many times what the input does between tests.
inline constexpr double kFewRows = 0.1;
inline constexpr double kElsewhere = 1e5;

/// Pulses of inputs (unanswered_pulses.hpp). So many times the input's usual move away and back;
/// back where no more than this share of it is left; and more of them than this share of the rows
/// are the input's own way. Chosen.
inline constexpr double kPulseMoves = 8.0;
inline constexpr double kPulseBack = 0.5;
inline constexpr double kMostPulses = 0.01;
/// A CV tells whether it has answered where the s.d. of its answer, to the model's, is less; and it
/// has where it shows as much: three s.d. at least. Chosen: a gain that is off by three quarters
/// still shows.
inline constexpr double kAnswerTold = 1.0 / 12;
inline constexpr double kAnswered = 0.25;
inline constexpr NoiseModel kPulseNoise = {};
inline constexpr int kLongestPulseAnswer = 1000;  ///< samples of it that are looked at

}  // namespace mpm
