#pragma once

#include <Eigen/Core>

/// The numbers of this room that decide how a model is taken. Where each comes from: see
/// core/mismatch/calibration.hpp.
namespace mpm::calibration {

/// What counts as the same, for a model that somebody typed.
namespace model_rounding {
/// A pole this near to 1, a sum of coefficients this small against them: an integrator. A pulse
/// response this small against what could come: none yet. Derived: seven digits above what double
/// precision loses, well below what anybody types.
inline constexpr double kSame = 1e-9;
/// The same of a root that comes of a polynomial whose sum of coefficients is 0 already: a double
/// root is known to half the digits.
inline constexpr double kSameRoot = 1e-6;
/// Dead times this near to whole samples are whole, in samples.
inline constexpr double kWholeSample = 1e-9;
/// A time this short of a disturbance's onset or end, in sample times, counts as that: seconds
/// since 1970 as a double are good to 0.2 us.
inline constexpr double kSameInstant = 1e-4;
}  // namespace model_rounding

/// Longest dead time, samples. Chosen: bounds memory and catches slipped units.
inline constexpr int kLongestDeadTime = 1000000;

/// A step response that stays below this share of its largest value has not begun: the samples
/// until then are its dead time. Chosen: identified responses are never quite 0.
inline constexpr double kNotBegun = 1e-3;

/// Samples over which a step response is watched for when it settles: a rest, and per slowest time
/// constant so many, more for each order and for each factor e of the tolerance. Chosen,
/// generously: n equal lags take n + a few sqrt(n) time constants.
namespace settling_horizon {
inline constexpr double kSamples = 10.0;
inline constexpr double kTimeConstants = 10.0;
inline constexpr double kPerOrder = 5.0;
inline constexpr double kPerLogTolerance = 2.0;
}  // namespace settling_horizon

/// A channel in samples at a longer sample time is its step response: until it stays this near to
/// its end, share of that, and no longer than so many samples. Chosen.
namespace longer_sample_time {
inline constexpr double kSettled = 1e-3;
inline constexpr int kMostSamples = 20000;
}  // namespace longer_sample_time

/// Tanks that are integrated within the sample.
namespace tanks {
/// Steps per fastest time constant. Errors of a level: 1e-6, and up to 2e-4 for a while after a
/// tank has run empty or begun to overflow (tests/core/model/tank_channel_test.cpp). A tank much
/// faster than the sample time follows its inflow: L-stability makes finer steps needless there.
inline constexpr double kStepsPerTimeConstant = 20.0;
inline constexpr double kMostSteps = 200.0;
/// Below this level (of the operating point's) the root bends sharply and a tank that fills again
/// is of order 1.5 only: its steps are parted.
inline constexpr double kNearlyEmpty = 0.05;
inline constexpr int kParts = 8;
}  // namespace tanks

/// Step responses in the form of a transfer function (tests/core/model/reduce_step_response_test).
/// All chosen.
namespace step_reduction {
/// Largest deviation, share of the largest coefficient: what tables are rounded to, and less than
/// any error that the monitor looks for.
inline constexpr double kTolerance = 0.01;
/// A richer structure is worth it where it deviates by this share of what the simpler one does, and
/// none is where that is within four digits.
inline constexpr double kMuchNearer = 0.1;
inline constexpr double kExact = 1e-4;
inline constexpr double kBase = 10.0, kDigits = 4.0;
/// Values for each number that is fitted; fewer are met by anything.
inline constexpr int kValuesPerNumber = 2;
/// Values that are fitted (all are checked), and the search: how often it begins again where it
/// ended, and steps of each time.
inline constexpr Eigen::Index kMostPoints = 500;
inline constexpr int kRestarts = 8;
inline constexpr int kSteps = 200;
/// Relative difference of time constants that is none: beyond, closed forms lose digits.
inline constexpr double kEqual = 1e-4;
/// Time constants in a lead: with a longer one, gain and lead are not to be told apart.
inline constexpr double kLongestLead = 100.0;
/// Samples of dead time that are none.
inline constexpr double kNothing = 1e-3;
/// Where the search begins with a second lag, share of the first.
inline constexpr double kSecondLag = 0.25;
}  // namespace step_reduction

}  // namespace mpm::calibration
