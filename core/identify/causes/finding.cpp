#include "core/identify/causes/finding.hpp"

namespace mpm {

const char* name_of(Cause cause) {
  switch (cause) {
    case Cause::kGain:
      return "gain";
    case Cause::kDeadTime:
      return "dead_time";
    case Cause::kTimeConstant:
      return "time_constant";
    case Cause::kDynamics:
      return "dynamics";
    case Cause::kInputScale:
      return "input_scale";
    case Cause::kOutputScale:
      return "output_scale";
    case Cause::kInputNonlinearity:
      return "input_nonlinearity";
    case Cause::kStiction:
      return "stiction";
    case Cause::kOutputNonlinearity:
      return "output_nonlinearity";
    case Cause::kUnmodelledInput:
      return "unmodelled_input";
    case Cause::kOutputDisturbance:
      return "output_disturbance";
    case Cause::kNoise:
      return "noise";
    case Cause::kStateNonlinearity:
      return "state_nonlinearity";
    case Cause::kUnnamed:
      return "unnamed";
  }
  return "";
}

}  // namespace mpm
