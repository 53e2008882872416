#pragma once

#include <array>
#include <cstddef>

/// Numbers that decide an identification, none of which a user sets. Chosen by hand on tuning seeds
/// where nothing else is said; what they give together is scored by tests/identify_score.
namespace mpm {

/// Rows per unknown of a CV's fit, of those that are fitted first (three quarters): with fewer,
/// intervals are too narrow by far. Three unknowns per input, and so many besides.
inline constexpr int kRowsPerUnknown = 5;
inline constexpr int kUnknownsPerInput = 3, kOtherUnknowns = 12;
inline constexpr double kStillShare = 1e-9;       ///< of its level: rounding, not movement
inline constexpr double kNumbersOfChannel = 3.0;  ///< gain, time constant, dead time
inline constexpr double kNotZero = 1e-300;        ///< to divide by

// The regression of high order (high_order.hpp).
inline constexpr int kDenseLags = 12;          ///< single lags of an input before the blocks
inline constexpr double kBlockGrowth = 1.2;    ///< of a block's lags to the block before it
inline constexpr int kLongestLag = 600;        ///< samples
inline constexpr int kShortestLag = 40;        ///< samples: of the last block, at least
inline constexpr double kLagShare = 0.125;     ///< of the mean run's rows: the last block's lag
inline constexpr int kPastLags = 12;           ///< of the CV's own past
inline constexpr double kRowsPerColumn = 3.0;  ///< rows behind each column, at least
inline constexpr double kDependent = 1e-7;     ///< of a scaled column that is left: none

// What CVs have in common (cross_noise.hpp).
inline constexpr int kCrossLags = 8;                ///< of every CV
inline constexpr double kCrossRowsPerColumn = 4.0;  ///< rows behind each column, at least
inline constexpr double kCrossPValue = 1e-4;        ///< below which the past of another CV tells
inline constexpr double kMostBrought = 20.0;        ///< s.d. of a CV: beyond, nothing settles
/// s.d. of it to that of the CV's noise, or it is not taken off.
inline constexpr double kLeastBrought = 0.2;

// Start values (start_values.hpp), in samples.
inline constexpr double kFastestStart = 0.6;
inline constexpr double kStartGrowth = 1.6;   ///< from one time constant to the next
inline constexpr double kSlowestStart = 2.0;  ///< of the last lag
inline constexpr double kLatestStart = 0.5;   ///< of the last lag
inline constexpr double kWorthTrying = 9.0;   ///< fall of the squared error, in its variance
inline constexpr std::size_t kSetsKept = 3;   ///< of each size
inline constexpr std::size_t kSetsTried = 4;  ///< on the data themselves
inline constexpr double kFullTimes[] = {5.0, 15.0, 45.0};  ///< samples: starts of all inputs
inline constexpr double kFullDeadTimes[] = {1.0, 4.0};     ///< samples
inline constexpr std::size_t kFullsKept = 2;
inline constexpr std::ptrdiff_t kLaterDeadTimes = 2;  ///< of the grid, from the one found on
inline constexpr double kLeastSharedGain = 0.02;      ///< of what makes it up
inline constexpr double kHopelessSets = 9.0;          ///< logs of the rows in BIC behind the best
inline constexpr int kSetSteps = 12;                  ///< of Gauss-Newton on the factor
inline constexpr double kSetDamping = 1e-3;           ///< to the size of a column
inline constexpr double kSetConverged = 0.05;         ///< variances

// Prediction errors (prediction_error.hpp).
inline constexpr int kNoiseOrder = 10;
inline constexpr double kRowsPerNoiseLag = 20.0;
inline constexpr double kDeadTimeStep = 0.25;    ///< samples: of a finite difference
inline constexpr double kLogStep = 0.01;         ///< likewise, of the log of a time constant
inline constexpr double kConverged = 0.01;       ///< fall of -2 ln likelihood
inline constexpr int kMostSteps = 25;            ///< of Gauss-Newton
inline constexpr int kMostCuts = 5;              ///< of a step
inline constexpr double kCut = 3.0;              ///< each by so much
inline constexpr double kDamping = 1e-6;         ///< to the size of a column
inline constexpr double kLeastVariance = 1e-24;  ///< of the CV's
inline constexpr double kFreePrior = 1e-9;       ///< of a level or a drift: none
inline constexpr double kNoLagLimit = 1e6;       ///< samples
inline constexpr double kFastest = 0.05;         ///< samples: of a time constant
inline constexpr double kStartState = 3.0;       ///< s.d. of the CV: of a first state
inline constexpr int kMostDecays = 3;            ///< time constants of a first state
inline constexpr double kOtherTime = 1.3;        ///< ratio of two that differ
inline constexpr double kNoWhitening = 1e-9;     ///< bound of an autoregression that does nothing
inline constexpr double kMostAutocorrelation = 0.98;
inline constexpr double kStepOfTimes = 1.5;     ///< most that a step changes the log of a time
inline constexpr double kStepOfDeadTime = 4.0;  ///< samples, likewise
inline constexpr double kStepOfDamping = 0.2;   ///< likewise

// How far a dead time may be off (dead_time_reach.hpp).
inline constexpr double kReachesOfDeadTime[] = {2.0, 3.0, 4.0, 6.0, 8.0, 12.0};  ///< s.d.
inline constexpr int kHeldSteps = 3;  ///< of Gauss-Newton

// Which channels, of which form (structure.hpp).
inline constexpr double kSureRatioSquare = 60.0;  ///< squared ratio of a gain to its s.d.
inline constexpr int kTrialSteps = 6;             ///< of Gauss-Newton
inline constexpr double kWorthRicher = 4.0;       ///< fall of BIC
/// Where a channel with lead begins, times the time constant that it had: slow tail, overshoot,
/// inverse response, a quick answer that mostly goes back, one that goes back further than it came,
/// a quick answer that creeps on.
struct LeadStart {
  double first, second, lead, gain;  ///< the gain times its own
};
inline constexpr LeadStart kLeadStarts[] = {{3.0, 0.7, 2.0, 1.0},     {1.0, 0.5, 1.5, 1.0},
                                            {1.0, 0.5, -0.5, 1.0},    {20.0, 0.7, 26.0, 1.0},
                                            {10.0, 1.0, -17.0, -0.5}, {50.0, 1.0, 42.0, 1.2}};
/// Of the quicker of two lags: where a third begins.
inline constexpr double kThirdShares[] = {0.3, 1.0};
/// Where a damped pair begins.
inline constexpr double kDampedStart = 0.4;
inline constexpr double kPairTime = 0.7;       ///< of half the dead time and the time constant
inline constexpr double kLeastDamping = 0.03;  ///< less does not settle
inline constexpr double kMostDamping = 0.8;    ///< more hardly overshoots: two lags
/// Of the longest run: a form with a slower time constant is not told from a drift.
inline constexpr double kSlowestShare = 0.5;
/// Of the longest run: so slow, it may as well integrate. Chosen.
inline constexpr double kMayIntegrateShare = 0.1;
inline constexpr double kSecondShare = 0.2;  ///< of the time constant: where a second begins

// What else fits (rival_fits.hpp).
/// -2 ln likelihood higher, at most: odds of 1 to 20, beyond which Kass and Raftery (1995) speak of
/// strong evidence.
inline constexpr double kAsGood = 6.0;
inline constexpr double kWorthFitting = 30.0;  ///< likewise, on the regression of high order
/// Move of a gain, of itself, that makes another input worth fitting.
inline constexpr double kMovesGain = 0.02;
/// Time constants to begin from, of the others' median.
inline constexpr std::array kBesideTimes = {0.5, 1.0, 2.0};

// Whether feedback moves the inputs (feedback_test.hpp).
inline constexpr int kFeedbackLags = 6;
/// Poles of the means of the inputs' past beside these lags: how long ago somebody moved an input a
/// CV that answers it slowly would know better than six lags do, as if it moved it. Chosen.
inline constexpr std::array kFeedbackPoles = {0.8, 0.95, 0.99};
inline constexpr double kFeedback = 1e-3;  ///< p-value below which it does
/// A binary or ternary test signal has so many levels; what a controller moves has hundreds.
inline constexpr std::size_t kTestLevels = 4;
/// Free run of a richer form on unseen rows, where no feedback is: most times the simplest one's.
inline constexpr double kMostWorse = 1.3;
inline constexpr double kClearlyBetter = 0.9;  ///< of the unseen squared error

// Long recordings (identify_long.hpp).
inline constexpr std::ptrdiff_t kMostIdentified = 20'000;  ///< rows that a model is made from
inline constexpr std::ptrdiff_t kScoutRows = 5'000;        ///< that tell how fast the plant is
inline constexpr std::ptrdiff_t kFiner = 8;                ///< times, where these show nothing

// What is said (identification.hpp).
inline constexpr double kValidationShare = 0.25;   ///< of the rows, left out of the choice of forms
inline constexpr double kOnlyFeedbackShare = 0.3;  ///< share of an input's movement from outside
inline constexpr double kFamilyError = 0.01;       ///< of any invented relation in a unit
inline constexpr double kSure = 2e-5;              ///< p-value of each relation in a model, besides
inline constexpr double kLeastContribution = 0.02;      ///< s.d. of a channel to that of its CV
inline constexpr double kVagueGain = 0.25;              ///< s.d. of a gain to the gain
inline constexpr double kEntangled = 0.8;               ///< correlation of two gains' estimates
inline constexpr double kMatters = 0.1;                 ///< s.d. of a channel to that of its CV
inline constexpr double kUsualTimeShare = 0.1;          ///< of the last lag: a time constant
inline constexpr double kLeastGainOfPrediction = 0.01;  ///< of the unseen innovations' variance
inline constexpr int kStepPoints = 60;                  ///< of a step response that is drawn
inline constexpr double kStepTimes = 5.0;               ///< time constants that it lasts
inline constexpr double kLeastValue = 1e-12;            ///< of a number that is changed by a share
inline constexpr int kWhitenessLags = 20;
inline constexpr int kLongestTestedLag = 200;  ///< samples: of an input against innovations

// A test plan (test_plan.hpp).
inline constexpr double kShareOfRange = 0.1;       ///< of an MV's limits: a move
inline constexpr double kShareOfCvRange = 0.25;    ///< of a CV's limits: what a move may do
inline constexpr double kMoreThanBefore = 3.0;     ///< times the s.d. that did not suffice
inline constexpr double kSettlingTimes = 5.0;      ///< time constants
inline constexpr double kSwitchShare = 1.0 / 3.0;  ///< of the settling time: mean time of a level
inline constexpr double kFewestSettlings = 6.0;    ///< that a test lasts
inline constexpr double kStepsOfTest = 4.0;        ///< up, down, up, back
inline constexpr double kStepSettlings = 4.0;      ///< as long as so many, steps will do
inline constexpr double kWantedSd = 5.0;           ///< an effect that matters, in its own s.d.
/// Dead time from which an inverse response is tried in its place, samples: shorter ones are told.
inline constexpr double kLongDeadTime = 5.0;
inline constexpr double kLeastReturn = 0.02;  ///< of the noise to its level, per sample

/// A CV's readings are put right by the model that they gave and identified again, so many times at
/// most, or until they change by less than this share of the one-step errors. Chosen: in cycles as
/// long as a time constant each leaves six tenths of what the one before was off, in shorter ones
/// a tenth (tests/core/identification/identify_readings_test.cpp).
inline constexpr int kReadingsAgain = 8;
inline constexpr double kReadingsPutRight = 0.05;

}  // namespace mpm
