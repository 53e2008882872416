#pragma once

#include <cstddef>
#include <cstdint>

/// The numbers of this room that decide which values count and which samples go together. Where
/// each comes from: see core/mismatch/calibration.hpp.
namespace mpm::calibration {

/// Repeated values (`Screen`).
namespace repeats {
/// Probability below which a run of repeated values is not taken for chance. Chosen: one run in a
/// million values.
inline constexpr double kChance = 1e-6;
/// Returns to the value before the last that make a signal a coarse one. Chosen: a fine one has
/// none.
inline constexpr int kReturns = 3;
/// Repetitions in a row from which on a fine one is frozen. Chosen: of four digits one in some
/// hundred values repeats the one before by chance, one in some ten thousand twice.
inline constexpr int kFrozenOfFine = 2;
/// What is presumed of a signal's share of repetitions: one in a hundred, as if seen in so many
/// values. Chosen.
inline constexpr double kPriorRepeated = 0.5;
inline constexpr double kPriorValues = 50.0;
/// Of an input, half of these are presumed to be repetitions, and no rest longer than so many
/// samples is a fault of the instrument. Chosen.
inline constexpr double kPriorRepeatedOfInput = 25.0;
inline constexpr int kLongestOfInput = 60;
/// Values exactly at the end of a signal's range that make that end a limit of the instrument.
/// Chosen.
inline constexpr int kEndHits = 3;
}  // namespace repeats

/// Values that jump away and right back (`Screen`).
namespace spikes {
/// So many times the usual difference it leaves and comes back. Chosen
/// (tests/sim/bad_data_alarms_test.cpp).
inline constexpr double kJump = 6.0;
/// And so many times what the value before had moved. Chosen: the peak of a wave moves less than
/// the sample before it.
inline constexpr double kSudden = 2.0;
/// It is back where it is nearer to the last value than this share of the jump. Chosen.
inline constexpr double kBackShare = 0.5;
/// Differences over which the usual one is followed; so many it takes to know one; and beyond how
/// many times the usual one a difference counts no more. Chosen, as the noise level's
/// (row_weights).
inline constexpr double kScaleSamples = 300.0;
inline constexpr double kFirstSamples = 30.0;
inline constexpr double kBound = 3.0;
}  // namespace spikes

/// Inputs that leave their range for a sample or two (`Screen`).
namespace pulses {
/// By more than so many widths of it. Chosen: from about there on a single value of 6000 changed
/// verdicts of a loop written for it.
inline constexpr double kAway = 1.0;
/// More of them than kMost in kSamples are the input's own way. Chosen: one in a hundred.
inline constexpr double kMost = 10.0;
inline constexpr double kSamples = 1000.0;
}  // namespace pulses

/// Values far outside what a signal has ever been (`Extent`, `Screen`). Chosen: an operator's step
/// is often ten times what a controller did before, and stays; what an instrument or a gateway
/// makes up is gone within a few samples, as abruptly as it came.
namespace extent {
/// Values by which a signal's range is first known. It is that of the closest of them, all but so
/// many, where the others were an excursion.
inline constexpr std::size_t kFirstValues = 30;
/// A range below this share of the level is the signal's last digits.
inline constexpr double kDigits = 1e-6;
/// So many widths outside, a value begins an excursion: the next time it takes twice as many. Of a
/// signal that had stood still any value does, so often.
inline constexpr double kIsolated = 10.0;
inline constexpr int kOftenFromRest = 3;
/// An excursion that is back within so many samples was none of the process.
inline constexpr int kLongestBurst = 10;
/// It is back within so many widths, or this share of how far it was one value before: the signal
/// may have moved on meanwhile.
inline constexpr double kHome = 1.0;
inline constexpr double kBackShare = 0.1;
/// So many widths outside, any value is none of the process, until so many have come in a row; of
/// one signal alone fewer are enough, as where its unit is another one for an hour: what happens to
/// a plant moves several.
inline constexpr double kTooFar = 1e4;
inline constexpr double kTooFarAlone = 1e3;
inline constexpr int kPatience = 60;
/// Of so many values, the first, a signal may turn out to have been elsewhere from its start on:
/// later, what was before is known better than to be given up. Chosen.
inline constexpr int kFirstPhase = 1000;
/// Where it has been since it must have moved so often. Chosen: what is switched between two values
/// does not.
inline constexpr int kMovesOfItself = 3;
/// No instrument gives more, in whatever unit.
inline constexpr double kLargest = 1e100;
}  // namespace extent

/// Blocks that come apart (`Aligner`), in control intervals. Chosen: what middleware reorders is
/// far less, and a gateway that is a thousand ahead on one topic has lost the others.
namespace alignment {
inline constexpr int kMaxLateness = 8;
/// Numbers beyond it, either way, are not taken: up to it they are exact in JSON and in doubles,
/// and no arithmetic on them comes near an overflow.
inline constexpr std::int64_t kLargestInterval = std::int64_t{1} << 53;
/// A leap beyond it is other numbers, not samples that are missing: 35 years of milliseconds.
inline constexpr std::int64_t kLongestGap = std::int64_t{1} << 40;
inline constexpr int kCapacity = 1024;
/// A number that is behind by more than this many times the lateness is a restart, not a late
/// block.
inline constexpr int kRestartFactor = 4;
/// One that is behind by less is a restart where the numbers went back by at least kSmallestReturn
/// while the source time went on. Chosen: two gateways with the same numbers are hardly so far
/// apart.
inline constexpr int kSmallestReturn = 3;
/// Other numbers are followed after so many frames of them while the old ones did not go on.
/// Where no frame is complete it takes as many blocks of each kind that comes. Chosen: a stray
/// number is one sample's, hardly two in a row.
inline constexpr int kReturnFrames = 3;
}  // namespace alignment

}  // namespace mpm::calibration
