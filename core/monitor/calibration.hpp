#pragma once

#include <array>
#include <cstdint>

/// The numbers of this room that decide what is said. What the user may set has its default in
/// settings.hpp, with what it means. Where each comes from: see core/mismatch/calibration.hpp.
namespace mpm::calibration {

/// Whether an error of interest would show.
namespace visibility {
/// S.d. of the gain estimate that an error must be worth to be seen: root of the noncentrality at
/// which a chi-square test of 6 degrees of freedom at level 0.01 / 9 has 94 % power. Derived
/// (tests/core/identify/diagnosis/calibration_test.cpp; 95 % would be 5.88).
inline constexpr double kSeenDeviations = 5.8;
/// Relative gain error beyond which nothing is said: where even that would not show, no data speak.
/// Chosen.
inline constexpr double kBlindGainError = 100.0;
/// Where the excitation is poor, only evidence counts whose p-value is below the usual rate times
/// this. Chosen: of some 1200 healthy channels of loops made elsewhere that were not excited none
/// was below (docs/validation.md, "Beside the best possible test"); where a disturbance that nobody
/// measures moves with an input, excited and other channels are accused alike.
inline constexpr double kConvincing = 0.1;
}  // namespace visibility

/// A CV whose readings mostly repeat moves by its resolution or not at all: its errors are then no
/// noise but follow where it is and how it moves. Chosen on loops made elsewhere (tests/foreign,
/// regime quantised, seeds 100001 to 100030).
namespace coarse_readings {
/// Share of repetitions from which on a CV is that coarse.
inline constexpr double kRepeatedShare = 0.45;
/// Of such a CV only evidence counts whose p-value is below this, where an error of interest would
/// show.
inline constexpr double kConvincingPValue = 1e-6;
/// Share beyond which none counts. Chosen: steps of four s.d. of the noise repeat 0.78 to 0.87 of
/// the readings (without the end of long runs), and of 22 sound runs of such a sensor five raised
/// an alarm, at p-values down to 0; steps of two repeat 0.65 to 0.74, and raised none.
inline constexpr double kMostlyRepeated = 0.75;
inline constexpr double kNothingConvinces = -1.0;
}  // namespace coarse_readings

/// What a historian's deadband took from an input weighs in a CV beyond so many s.d. of its
/// one-step errors. Chosen: a tenth of its variance, as of one that comes and goes with the input.
namespace held_inputs {
inline constexpr double kShareOfNoise = 0.3;
/// Of what is anywhere within +-1. Derived.
inline constexpr double kVarianceOfUniform = 1.0 / 3.0;
}  // namespace held_inputs

/// When data are too bad for a verdict.
namespace bad_data {
/// Unknown values of a signal in a row that may be taken as unchanged, samples. Chosen.
inline constexpr std::int64_t kHeldSamples = 5;
/// More than this share of a CV's samples without a residual, exponentially weighted over so many
/// samples (the memory of the noise level). Chosen.
inline constexpr double kMostShare = 0.5;
inline constexpr double kShareSamples = 300.0;
/// A signal is lost where more than this share of its values cannot be used, exponentially weighted
/// over so many samples and the lags of a channel: about as long as stops verdicts, three dozen
/// samples where lags are few. It is back below kFoundShare. Chosen.
inline constexpr double kLossSamples = 30.0;
inline constexpr double kFoundShare = 0.25;
/// Values that an instrument falsifies are not missing at random (it clips what is large): no more
/// than this share of implausible ones over so many samples. Chosen; 20 % frozen or clipped values
/// give no verdict, 5 % do (docs/validation.md, bad data).
inline constexpr double kImplausibleShare = 0.1;
inline constexpr double kImplausibleSamples = 1000.0;
/// Where spikes are found more often than this, others side by side pass the screen unseen. Chosen:
/// without it spikes in 1 % of the values gave a false alarm in 1 run of 20.
inline constexpr double kSpikyShare = 0.003;
/// A CV that has no verdict after so many times the samples it needs has bad data, and is not just
/// warming up. Chosen.
inline constexpr double kWarmUps = 2.0;
}  // namespace bad_data

/// CVs that are judged at their readings (`SeldomCvs`). Chosen.
namespace seldom_read {
/// Lags of a channel, readings: no fewer, so that a dead time that is off shows.
inline constexpr int kFewestLags = 8;
/// Cycles in which the next reading must have come, or what stands is none.
inline constexpr double kStandingCycles = 2.0;
}  // namespace seldom_read

/// When predictions are taken for corrected by the measurement (`FeedbackCorrection`). Chosen on
/// loops whose controller's model is another one than the unit file's, with next to no noise, where
/// nothing is corrected, and on corrected ones whose values have four digits
/// (tests/core/monitor/feedback_correction_test.cpp).
namespace feedback_correction {
inline constexpr int kBlock = 100;     ///< samples that are asked together
inline constexpr int kBlocksOver = 3;  ///< in a row that no longer say so, until it is over
/// The measurement itself is what differs from it by less than this share of its own moves, mean
/// squares; and is no simulation where the bias moves by more than that share.
inline constexpr double kSame = 1e-8;
inline constexpr double kMovesShare = 1e-2;
/// The last residual explains so much of how the bias moves, and leaves so little of what the
/// bias's own past does not explain; shares of squares.
inline constexpr double kOfResidual = 1e-5;
inline constexpr double kLeft = 0.25;
/// By this share of it predictions are corrected; by this share of that share, at most, the bias's
/// own past moves it besides; and two blocks agree within this.
inline constexpr double kSmallest = 0.02;
inline constexpr double kLargest = 1.1;
inline constexpr double kSides = 0.2;
inline constexpr double kAgree = 0.1;
}  // namespace feedback_correction

/// When predictions are taken for those of another model (`ModelAgreement`). Chosen: what a
/// discretisation, a truncated step response, rounding or a historian's deadband make of a model is
/// less, a gain that is off by a quarter in the channel that moves the CV most is more.
namespace model_agreement {
inline constexpr int kBlock = 500;  ///< samples that are asked together
inline constexpr int kBlocks = 3;   ///< in a row that have to say the same
/// s.d. of the difference to that of what the model gives: of another model, and no longer.
inline constexpr double kOther = 0.2;
inline constexpr double kSame = 0.1;
}  // namespace model_agreement

/// How an input moves: for the reason of a verdict that is undetermined. Chosen.
namespace input_motion {
inline constexpr double kMostOfTheTime = 0.5;  ///< share of the samples
inline constexpr int kStillSamples = 60;       ///< without any movement: it stands still
inline constexpr double kAtEnd = 1e-6;         ///< share of its range within which it is at the end
inline constexpr double kMemoryShare = 0.25;   ///< of the samples that a CV remembers
}  // namespace input_motion

/// How often a CV in which something is off is asked what it follows, samples. Chosen: an alarm
/// takes some time, and asking costs as much as some hundred rows.
namespace confounding {
inline constexpr std::int64_t kBetween = 50;
/// A signal's means are over the slowest time constant and times each so many times shorter.
inline constexpr double kPoleRatio = 3.0;
}  // namespace confounding

/// What an alarm takes beside the p-values that the user may set.
namespace alarms {
/// That the error matters may be a little less certain than that there is one: to raise an alarm it
/// must have at most this p-value. Chosen.
inline constexpr double kMattersPValue = 1e-3;
/// An alarm stays while its error is significant at this level and might matter. Chosen.
inline constexpr double kStaysPValue = 0.05;
inline constexpr int kOnDelaySamples = 10;   ///< unless the user sets one; chosen
inline constexpr int kOffDelaySamples = 60;  ///< likewise
}  // namespace alarms

/// When a change is looked for, and believed. Chosen, on the experiments `change_*` of the study's
/// prototype.
namespace change_search {
inline constexpr std::int64_t kBetween = 100;       ///< samples from one search to the next
inline constexpr std::int64_t kBetweenUrgent = 20;  ///< where the errors are much larger than usual
inline constexpr double kUrgentSurprise = 2.0;      ///< ratio of mean squares: that much larger
/// Worth a search: an error this likely, or errors this much larger than usual (ratio of mean
/// squares). While a memory spans a change its p-value is slow to fall.
inline constexpr double kSuspiciousPValue = 1e-5;
inline constexpr double kSuspiciousSurprise = 1.3;
/// A change is certain where its p-value, of the likeliest moment and input, is below this. At one
/// sample a second a year has 3e5 searches of a hundred moments each: once in thirty years.
inline constexpr double kCertainPValue = 1e-9;
}  // namespace change_search

/// Memories in effective samples, (1 + lambda) / (1 - lambda). Chosen: the long one sees gain
/// errors of some 5 % on Shell (docs/validation.md), the fast one large ones sooner.
namespace memories {
inline constexpr double kEffectiveSamples = 4000.0;
inline constexpr double kFastEffectiveSamples = 1000.0;
/// Memories of fewer rows than these per column could hardly tell the columns apart.
inline constexpr double kRowsPerColumn = 15.0;
inline constexpr double kFastRowsPerColumn = 8.0;
/// Samples remembered for a fresh start, as a multiple of the long memory's.
inline constexpr double kRememberedShare = 1.2;
}  // namespace memories

/// How often a CV is evaluated: it costs as much as several rows, and what it says changes slowly.
namespace evaluation {
/// For 88 columns every eighth sample. Chosen.
inline constexpr double kColumnsPerStride = 11.0;
inline constexpr int kLongestStride = 30;  ///< samples
/// How large an error is takes time in proportion to the lags that a response is looked at: for 400
/// of them every second sample. What is that slow changes slowly, too. Chosen.
inline constexpr double kLagsPerStride = 200.0;
/// The threshold of F is kept until the degrees of freedom have changed by this share, which moves
/// it by some 1e-5. Chosen.
inline constexpr double kKeptThresholdShare = 0.01;
}  // namespace evaluation

/// The regression's columns, where the user leaves them to be derived. Chosen: block size and order
/// are those of the prototype's best test (20 lags and a tail; eight lags of all residuals, which
/// noise that is coupled between CVs needs).
namespace regression_shape {
inline constexpr int kFewestFirLags = 20;
inline constexpr int kMostFirLags = 60;
/// An error in the dead time must stay inside the pulse lags: this many samples beyond the longest.
inline constexpr int kDeadTimeMargin = 13;
/// So must the swings of a response that oscillates, which no tail can follow, down to this share
/// of the largest.
inline constexpr double kSwingThatMatters = 0.05;
inline constexpr int kResidualOrder = 8;
/// Beyond them exponentially weighted means of so many samples.
inline constexpr std::array kResidualMeans = {8.0, 40.0};
/// One tail with the slowest time constant, and further ones, each this many times faster, as long
/// as they are slower than the pulse lags can show (so many times their number).
inline constexpr double kTailRatio = 4.0;
inline constexpr double kSlowerThanLags = 2.0;
}  // namespace regression_shape

/// What a monitor takes (`monitor_cost`). Measured, `./run bench`: seconds for each entry of a
/// factor that a row is rotated into, for each that an evaluation inverts, for each lag of a pulse
/// and number of what it is projected on where the size of an error is fitted; and for each rank
/// that a sample moves (docs/nonlinear.md).
namespace cost {
inline constexpr double kPerRotated = 2e-10;
inline constexpr double kPerInverted = 1e-10;
inline constexpr double kPerFitted = 4e-8;
inline constexpr double kPerRanked = 1.3e-9;
}  // namespace cost

/// Samples that rank correlations are over, at most: sums of their squares stay whole numbers.
/// Derived: (10^6)^3 / 3 is below 2^63.
namespace correlations {
inline constexpr double kMostRanked = 1e6;
}  // namespace correlations

/// No setting counts more samples than these: an int holds them, and nobody waits for them.
inline constexpr double kMostSamples = 1e9;

/// Slowest time constants after which what a wrong start left behind is below 1 %. Derived:
/// exp(-5) = 0.7 %.
namespace simulation {
inline constexpr double kSettlingTimeConstants = 5.0;
/// At its start it need not be forgotten: what it leaves behind are decays, which the regression
/// takes out. Slowest time constants after which decays with these shares of the slowest time
/// constant are all that is left. Chosen (tests/core/monitor/wrong_start_test.cpp).
inline constexpr double kStartingTimeConstants = 0.7;
inline constexpr std::array kStartPoles = {1.0, 0.6, 0.3};
/// Of the samples remembered, at most: a channel slower than all that is remembered blinded the
/// unit for good. Chosen.
inline constexpr double kLongestStartingShare = 0.25;
/// Samples behind its dead time in which a channel that acts at all has moved. Chosen.
inline constexpr double kBeginsToAnswer = 20000.0;
}  // namespace simulation

}  // namespace mpm::calibration
