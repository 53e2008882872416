#pragma once

#include <array>

/// The numbers of this room that decide what is said of a channel. Where each comes from:
///
///   fitted   on seeds from 100001 on, which score nothing; `./run calibrate` fits them again;
///   derived  from the paper or formula that is named;
///   chosen   by hand on prototypes with other generators and seeds. `./run study` shows what the
///            choice gives (docs/validation.md), the named test what it is for.
namespace mpm::calibration {

/// Of the largest value that a signal has had: what is below is rounding, of a simulation without
/// noise. Instruments have a million times more. Chosen.
inline constexpr double kRounding = 1e-12;

/// Errors of a channel's model up to which it is good enough, unless the user sets others. Chosen:
/// a controller hardly notices errors that small; some error every model has.
namespace materiality {
inline constexpr double kGain = 0.05;            ///< relative
inline constexpr double kTimeConstant = 0.10;    ///< relative
inline constexpr double kDeadTimeSamples = 0.5;  ///< half the resolution of a control interval
/// Of the time constant, if that is more: lags that were fitted to a plant of higher order have a
/// dead time that is off by as much; the thesis's third scenario, of 8 to 12 %, by twice as much.
inline constexpr double kDeadTimeShare = 0.04;
/// Relative, over the response (`StepErrors`): one or two lags that were fitted to a plant's steps
/// are off by as much, a dead time that is off by a twentieth of the time constant likewise.
inline constexpr double kStepResponse = 0.02;
/// Of what an input does so much may be of a kind that no linear channel has, a curve say. Where
/// other inputs undo most of it, it is a larger part of what is left: it does not matter what
/// errors come of it. Chosen on a column that two inputs move against one another (tests/foreign).
inline constexpr double kNoChannel = 0.015;
/// So many times less is known of a gain for the other inputs, up to which nothing more is borne.
/// Chosen: under usual controllers 1 to 5, of that column 30 to 90.
inline constexpr double kUndone = 8.0;
/// Above this p-value nothing has to be looked at again.
inline constexpr double kAskedBelow = 0.05;
}  // namespace materiality

/// Over what of a channel's step response an error of it is measured (`StepErrors`). Chosen.
namespace step_errors {
inline constexpr double kSettled = 0.05;   ///< of the largest value, from the last one
inline constexpr double kBeyond = 1.5;     ///< times as long as it takes to come so near
inline constexpr double kLater = 0.5;      ///< weight of a value just behind that
inline constexpr double kLagRatio = 1.05;  ///< of neighbouring lags behind the block's own
/// Newton steps to the nearest error of a size, at most; and how exact, of the size.
inline constexpr int kMostSteps = 60;
inline constexpr double kExact = 1e-12;
}  // namespace step_errors

/// In a regression on its own past F is too large on few rows, by 1 + factor c + factor c^2 with
/// c = columns / freedom (Bartlett 1937 on such factors): the residuals' past comes out too fast,
/// and what moves slowly seems too certain. Fitted on Shell, seeds from 100001 on, the squares with
/// those of noisy walks (docs/validation.md)
namespace few_rows {
inline constexpr double kDirected = 1.35;  ///< of the test for the usual errors, 1
inline constexpr double kDirectedSquare = 6.0;
inline constexpr double kBlock = 0.26;  ///< of the test of the whole block, 1
inline constexpr double kBlockSquare = 1.0;
}  // namespace few_rows

/// Rows that a memory must hold before anything is said. Fitted likewise (docs/validation.md)
namespace rows_needed {
inline constexpr double kPerColumn = 5.0;
}  // namespace rows_needed

/// Shares of clipped rows (beyond row_weights::kClip) from which on tails count as somewhat and as
/// very heavy; normal noise has 0.0027. Fitted likewise (docs/validation.md)
namespace heavy_tails {
inline constexpr double kFromShare = 0.008;
inline constexpr double kFullShare = 0.02;
/// Rows that stand behind the presumption that they are not. Chosen.
inline constexpr double kPriorRows = 200.0;
}  // namespace heavy_tails

/// When what is older than kMemories is forgotten at once, for an input moved then as it has not
/// since: looked kLooks times in that time, so that nothing outlives two memories; where what a
/// column holds since is less than kOutweighed of what it would be if it had always moved alike. An
/// input that has rested for the last kLately-th of it is left alone. Chosen: an input that moved
/// three times as far before has more than that share.
namespace older_movement {
inline constexpr double kMemories = 1.75;
inline constexpr int kLately = 4;
inline constexpr int kLooks = 8;
inline constexpr double kOutweighed = 1.0 / 3.0;
}  // namespace older_movement

/// How rows are weighed by their own prediction errors.
namespace row_weights {
/// Rows over which the noise level is followed, and the error in s.d. beyond which a row is trusted
/// less. Chosen: with these the false alarms stay nominal where the noise trebles or has heavy
/// tails, at the price of some power on 1000 samples.
inline constexpr double kNoiseRows = 300.0;
inline constexpr double kClip = 3.0;
/// The same where a change is looked for: after one many rows surprise, and they are what tells of
/// it. Chosen (tests/core/mismatch/change_scan_test.cpp).
inline constexpr double kLenientClip = 6.0;
/// Where tails are heavy a row whose leverage, in units of the noise variance, is above this counts
/// for part of one, of a direction never seen for the least part. Chosen on such tails, seeds from
/// 100001 on: with 4 in place of 2 p < 1e-4 comes twice as often. What is known of a direction
/// trebles with each row that counts for a part: after four moves of an input that had stood still
/// a fifth is whole.
inline constexpr double kMostLeverage = 2.0;
inline constexpr double kLeastShare = 0.02;
/// Rows per column that give the first estimate of the noise level. Chosen: two thirds of them are
/// left for it.
inline constexpr int kFirstRowsPerColumn = 3;
/// After each start as many rows are weighed together, by what the fit leaves of them, so often.
/// Chosen: a wild row among them has lost its weight then (residual_regression_test).
inline constexpr int kSettlingTurns = 5;
/// Of a row that the fit follows nearly all the way no less than this is taken to be left, as a
/// share of its variance. Chosen: half of it is left of a usual one.
inline constexpr double kLeastLeft = 0.02;
/// Median of |x| of a standard normal x.
inline constexpr double kMedianMagnitude = 0.6745;
/// Rows over which the errors of now are compared with those of long; chosen.
inline constexpr double kRecentRows = 100.0;
inline constexpr double kLastingRows = 2000.0;
/// Leverage in units of the noise variance above which a row says more of a direction hardly seen
/// before than of the noise: of rows that wait together all say the same, so they do not move what
/// is known of the noise. Derived: half of such an error's variance is the prediction's.
inline constexpr double kNewDirectionLeverage = 1.0;
/// While there are fewer rows per column each one teaches the next what to expect: their prediction
/// errors would have too much in common if they were taken together. Chosen.
inline constexpr int kTogetherRowsPerColumn = 10;
}  // namespace row_weights

/// Unknown residuals in a row that are interpolated. Chosen: what is guessed over longer gaps would
/// correlate with the inputs through the feedback (tests/sim/bad_data_alarms_test.cpp).
namespace gaps {
inline constexpr int kInterpolated = 2;  ///< samples
}

/// What a simulation's wrong start leaves behind is of no more interest below this share of it.
/// Derived: five of the slowest time constants.
namespace start {
inline constexpr double kForgotten = 0.0067;
}

/// A sliding window is rebuilt each time it has grown by one of so many parts. Chosen: a compromise
/// of cost against how sharp its edge is.
namespace sliding_window {
inline constexpr int kParts = 8;
}

/// The errors that a channel's model usually has, as directions.
namespace usual_errors {
/// Dead-time errors, samples: the response that much later, minus the response. Chosen: with these
/// and the derivatives by gain and time constant the test had most power on prototypes.
inline constexpr std::array kDelayShifts = {-2, 2, 6};
/// Step of the derivative by the logarithm of the time constants, relative. Chosen: small against
/// what is told apart, large against one sample's interpolation.
inline constexpr double kTimeConstantStep = 0.1;
/// Below this p-value no combination of them explains what is seen. Chosen.
inline constexpr double kUnusualPValue = 1e-3;
/// Slowest time constants over which the tails are fitted to a step response, and the samples that
/// this is at least and at most. Derived: exp(-8) = 0.03 % is left after it.
inline constexpr double kTailFitTimeConstants = 8.0;
inline constexpr int kTailFitFewest = 50;
inline constexpr int kTailFitMost = 20000;
}  // namespace usual_errors

/// When a CV's channels are judged among usual errors alone (`JointErrors`). Chosen: what else may
/// be wrong is looked for with this much false doubt, which costs power only.
namespace joint_errors {
inline constexpr double kAdequatePValue = 0.05;
/// On fewer degrees of freedom per column the CV's own lags are too uncertain, and a large error of
/// one channel leaks into those of others. Chosen.
inline constexpr double kFreedomPerColumn = 6.0;
/// A CV's own lags and its channels' errors are learnt by turns, while one takes off more than this
/// many variances. Chosen.
inline constexpr int kTurns = 4;
inline constexpr double kWorthAnotherTurn = 1e-3;
}  // namespace joint_errors

/// When the channels of several CVs are judged at once (`CoupledErrors`). Chosen.
namespace coupled_errors {
inline constexpr int kMostCvs = 3;
/// Of a channel by its CV's own regression, below which those of CVs that rest on this one's
/// residual are judged beside it: a right one does that in one of a thousand times.
inline constexpr double kDoubtedPValue = 1e-3;
/// Together with others, above which what a CV's own regression rejects is no error of its own.
inline constexpr double kElsewherePValue = 1e-2;
/// Of "a CV's residual says nothing of another's next one".
inline constexpr double kUncoupledPValue = 1e-3;
/// Turns of Gauss-Newton at most, and the variances that one may still move where it has settled.
inline constexpr int kTurns = 8;
inline constexpr double kSettled = 0.05;
/// Multiplications of a turn at most: of a large unit fewer CVs are judged together, or none.
/// Ten inputs and twenty CVs take half of it with three.
inline constexpr double kMostWork = 2e8;
}  // namespace coupled_errors

/// The sizes of errors that are not small (`ErrorSizes`). Chosen: from these starts a gain, a time
/// constant or a dead time that is off by up to a factor of 3 or 10 samples is found
/// (tests/core/mismatch/error_sizes_test.cpp).
namespace error_sizes {
/// Below this p-value of "no error" an error may be too large for its linear estimate.
inline constexpr double kRefinedBelow = 1e-3;
/// ln of the time constants' ratio, and dead time in samples.
inline constexpr std::array<std::array<double, 2>, 6> kStarts = {
    {{0.0, 3.0}, {0.0, 6.0}, {0.0, 10.0}, {0.7, 0.0}, {-0.7, 0.0}, {0.0, -3.0}}};
inline constexpr int kMostSteps = 8;
inline constexpr int kMostHalvings = 4;
/// In variances of the estimates.
inline constexpr double kWorthAnotherStep = 1e-3;
/// Differences that slopes are taken of: gain, ln time, samples.
inline constexpr std::array kSlopeSteps = {0.01, 0.02, 0.25};
/// No estimate leaves these.
inline constexpr double kMostGain = 100.0;
inline constexpr double kMostLogTime = 2.5;
}  // namespace error_sizes

/// A signal that is no input is what a CV follows if it explains more of the residual than usual
/// errors of all channels do, by so many noise variances, and at least so much of what any errors
/// of theirs could. Chosen on loops made elsewhere (tests/foreign, seeds from 100001 on): a signal
/// that disturbs passes in 8 of 9, errors of channels in none of 44.
namespace confounding {
inline constexpr double kMargin = 10.0;
inline constexpr double kShare = 0.5;
/// A signal that explains something beside usual errors of the channels, by a test of this p-value,
/// is no other word for them. Chosen (docs/validation.md).
inline constexpr double kBesidePValue = 0.001;
/// What goes with the inputs of a CV, so many s.d. beyond chance, is like no errors of its channels
/// where these explain less than this share of it. Chosen on the same loops: of what an operator's
/// answer to a hidden disturbance makes of six MVs they explain 0.14 at most once that is 70 noise
/// variances, of true errors 0.4 to 1.5.
inline constexpr double kBeyondChance = 1.0;
inline constexpr double kUsualShare = 0.25;
}  // namespace confounding

/// The other inputs mask one where they make its gain's s.d. this many times larger. Chosen.
namespace confounding {
inline constexpr double kMasked = 2.0;
}

/// Whether a CV's answer depends on where the plant is operated (`VolterraTerms`).
namespace curvature {
/// Inputs whose products are looked at, those that moved the CV most. Chosen: ten products cost a
/// fifth more than a CV's usual columns.
inline constexpr int kMostInputs = 4;
/// Rows beyond the columns that each term needs. Chosen.
inline constexpr int kFreedomPerColumn = 10;
/// Taken in below this p-value, as certain as a change has to be (core/monitor, change_search).
inline constexpr double kCertainPValue = 1e-9;
/// Of one channel, once that is certain. Chosen.
inline constexpr double kChannelPValue = 1e-6;
/// Where noise nearly integrates, 1 - a_1 - ... - a_p is no less: what is said of the gain's
/// variation is then too little. Chosen.
inline constexpr double kLeastOwnGain = 0.02;
/// Of what the second order explains, what orders beyond it may pass off as a change; and of a
/// gain's variation, what does not matter as an error. Chosen on healthy runs of the recovery
/// boiler, seeds 1 to 8.
inline constexpr double kBeyondShare = 0.1;
inline constexpr double kHarmlessShare = 0.25;
/// No more is said of a variation than that the gain is anything from none to twice its own.
/// Chosen.
inline constexpr double kMostVariation = 1.0;
}  // namespace curvature

/// The search for the moment of a change.
namespace change_scan {
inline constexpr int kMoments = 100;  ///< looked at; chosen: one per cent of the memory
/// By how many residual variances a change must beat no change. Chosen: chance gives a few.
inline constexpr double kMargin = 20.0;
/// What m more parameters gain by chance is chi-square with mean m and variance 2 m; so many s.d.
/// above the mean they must gain. Chosen, for the best of all moments.
inline constexpr double kChanceDeviations = 6.0;
/// Above this p-value no input explains anything since a change. Chosen.
inline constexpr double kNothingPValue = 1e-3;
/// Rows beyond the columns below which a part's variance is not known. Chosen.
inline constexpr int kFewestFreedom = 15;
/// Rows per column since a change that ended nothing and began nothing: fewer could not tell twice
/// as many coefficients apart. Chosen.
inline constexpr int kRowsPerColumn = 2;
}  // namespace change_scan

/// Where rounding ends what can be known; relative s.d. or squares of them. Derived from double
/// precision (2.2e-16) with room for what some thousand rotations lose.
namespace rounding {
/// A column of which less than this share is its own is held at that share: the variances of
/// everything that depends on it then come out huge instead of meaningless.
inline constexpr double kOwnShare = 1e-7;
/// Above this own share of every column the regression's coefficients are worth reading. Chosen:
/// below, their errors are a thousand times those of independent columns.
inline constexpr double kSeparableShare = 1e-3;
/// A direction of which the ones before it leave less is none of its own.
inline constexpr double kIndependentShare = 1e-6;
/// The same of a column of the three in `box_least_squares`, which nothing has blurred before.
inline constexpr double kFreeShare = 1e-12;
/// An input whose own movement (residual sum of squares given the others) is below this fraction of
/// its total carries rounding noise only: relative s.d. 1e-9, well above eps and well below any
/// collinearity that double precision can still resolve
/// (tests/core/mismatch/lagged_correlation_test.cpp).
inline constexpr double kOwnMovementSquare = 1e-18;
}  // namespace rounding

}  // namespace mpm::calibration
