#pragma once

#include <string>

namespace mpm {

/// In what a number of a finding is given.
enum class Unit {
  kNone,
  kOfModel,  ///< a ratio, plant over model
  kSeconds,
  kCv,  ///< that of the finding's CV
  kCvPerSecond,
  kInput,  ///< that of what acts: the finding's input or measured signal
  kCvPerInput,
};

/// How a fit holds a number that reports give plainly.
enum class Form {
  kPlain,
  kLog,      ///< its natural logarithm
  kSamples,  ///< a time in samples, reported in s
};

/// What a fitted number is. Two numbers mean the same if they point to the same quantity.
struct Quantity {
  const char* name;  ///< as the contract says it: `gain_ratio`, `dead_time_error`, ...
  Form form;
  Unit unit;
};

/// Errors of a channel, plant against model.
inline constexpr Quantity kGainRatio{"gain_ratio", Form::kPlain, Unit::kOfModel};
inline constexpr Quantity kTimeConstantRatio{"time_constant_ratio", Form::kLog, Unit::kOfModel};
inline constexpr Quantity kDeadTimeError{"dead_time_error", Form::kSamples, Unit::kSeconds};
inline constexpr Quantity kDampingRatio{"damping_ratio", Form::kLog, Unit::kOfModel};

}  // namespace mpm
