#pragma once

#include <Eigen/Core>
#include <array>

/// Numbers that decide how a fit goes, none of which a user sets. Chosen by hand from what they
/// mean; no command fits them. The priors are with the causes. What they give together is scored by
/// `mpm_hidden` (tests/hidden).
namespace mpm {

// Gauss-Newton.
inline constexpr int kMostHalvings = 3;            ///< of a step
inline constexpr double kWorthAnotherStep = 0.02;  ///< fall of the misfit, -2 ln of likelihood
inline constexpr double kNoMovement = 1e-4;        ///< prior s.d.
inline constexpr double kLeastVariance = 1e-30;    ///< of innovations: an exact fit stays finite

// Small errors that are fitted beside any effect.
inline constexpr double kSmallRatioStep = 0.01;     ///< of finite differences, of gain and time
inline constexpr double kSmallDeadTimeStep = 0.25;  ///< samples
/// A CV's level is uncertain by its misfit, at least by this share of what it moves.
inline constexpr double kLeastLevel = 1e-6;
/// A level that has more than this share of the misfit's mean square is far off.
inline constexpr double kLevelFarOff = 0.5;
/// Its first state by its first errors, at least by this share, and by so many of its moves in a
/// row: noise alone is off by a few.
inline constexpr double kLeastFirstState = 1e-3;
inline constexpr double kMovesOfNoise = 5.0;
/// Poles of the means over another CV's noise that may go before a CV's own (`noise_before`): its
/// last value, and means of some three, ten and thirty rows.
inline constexpr std::array kNoiseBeforePoles = {0.0, 0.6, 0.9, 0.97};
/// Rows in which a jump looks like a shock of the noise.
inline constexpr Eigen::Index kShockRows = 3;

// Rows' weights (row_weights.hpp).
inline constexpr Eigen::Index kHalfWindow = 150;  ///< rows
inline constexpr Eigen::Index kFewestInWindow = 30;
inline constexpr double kClip = 3.0;      ///< s.d. beyond which a row counts less
inline constexpr double kQuietest = 0.1;  ///< of the usual s.d.: no stretch weighs more

// A plateau (plateau.hpp).
inline constexpr std::size_t kFewestForPlateau = 100;  ///< known values
inline constexpr std::size_t kPlateauRows = 8;         ///< that share a value, at least
inline constexpr double kPlateauShare = 0.005;         ///< of the samples, at least
inline constexpr std::size_t kPlateauOthers = 10;      ///< values next to it
inline constexpr std::size_t kPlateauExcess = 5;       ///< times as many as share any of those
/// A CV that rests, or one peak, is no clipping: the level is come to so often, from away by this
/// share of what the CV moves.
inline constexpr int kPlateauVisits = 2;
inline constexpr double kPlateauLeft = 0.05;
/// Two values of a plateau differ by no more than this share of what the CV moves.
inline constexpr double kPlateauTie = 1e-9;

// The first state (initial_state.hpp).
inline constexpr double kOtherDecay = 1.2;        ///< time constants that differ by this ratio
inline constexpr int kFirstRows = 5;              ///< whose errors say how far off it is
inline constexpr Eigen::Index kDecayRows = 20;    ///< that the decays are fitted to, at least
inline constexpr Eigen::Index kDecayQuarter = 4;  ///< and at most this part of the data

// Step responses of a state space (channel_edit.hpp).
inline constexpr double kSettledShare = 1e-6;  ///< still to come
inline constexpr int kLongestResponse = 5000;  ///< samples

/// A border further than this share of all rows from where the fit is to end is not near
/// (split.hpp): between half and five sixths of the rows are fitted where two thirds are asked for.
inline constexpr double kFarBorder = 1.0 / 6.0;
/// A change that is dated this share of the fitted rows behind them at most counts as within them:
/// no search of them can find it, and of an actuator that is stuck from there on nothing was said.
/// Chosen: twice the 40 rows of some 2700 to which such a change is dated.
inline constexpr double kJustBehind = 0.03;

// Runs (runs.hpp): no shorter gap parts them, and no shorter one is kept beside others. The first
// state and the noise model take some 20 rows of each.
inline constexpr double kShortestLongGap = 20.0;  ///< intervals
inline constexpr Eigen::Index kShortestRun = 40;  ///< rows

/// A model has settled after so many slowest time constants: 5 % are left to come (horizons.hpp).
inline constexpr double kSettlingTimeConstants = 3.0;

/// A CV is read in the same cycle in another recording where they differ by no more than this
/// share. Chosen: an analyser's clock is better, and where it is not its readings keep to no grid.
inline constexpr double kSameCycle = 0.01;

// Long recordings (condense.hpp).
inline constexpr double kOfRow = 1e-6;         ///< by which a row may be short of a whole number
inline constexpr Eigen::Index kStretches = 8;  ///< that are chosen, where not all rows are taken
inline constexpr double kRowsOfFastest = 8.0;  ///< in the fastest time constant, at least
inline constexpr double kSlowestSpanned =
    200.0;  ///< slowest time constants in all rows that are left
inline constexpr Eigen::Index kFewestMoves = 20;  ///< that show how long an input is held

/// Data that hold so many slowest time constants can tell what wanders from what settles.
inline constexpr double kLongTimeConstants = 20.0;

// A random walk (walk.hpp).
/// Coefficients of the autoregression of a random walk's steps under noise. Chosen: what it forgets
/// of such noise makes the walk seem the larger (zero at 0.93: its s.d. by a fifth).
inline constexpr int kWalkOrder = 24;
/// How often these and the small errors beside them are set in turn. Chosen.
inline constexpr int kWalkPasses = 2;

/// Of a sample: two moments are the same.
inline constexpr double kSameMoment = 1e-6;

}  // namespace mpm
