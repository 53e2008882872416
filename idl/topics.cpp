#include "idl/topics.hpp"

namespace mpm::idl {

const char* sample_topic(SignalKind kind) {
  switch (kind) {
    case SignalKind::kMv:
      return "mpm/mv";
    case SignalKind::kDv:
      return "mpm/dv";
    case SignalKind::kCv:
      return "mpm/cv";
    case SignalKind::kPrediction:
      return "mpm/prediction";
    case SignalKind::kSetpoint:
      return "mpm/setpoint";
    case SignalKind::kRaw:
      return "mpm/raw";
    default:
      return nullptr;
  }
}

const char* kind_name(SignalKind kind) {
  const char* topic = sample_topic(kind);
  return topic == nullptr ? nullptr : topic + sizeof("mpm/") - 1;
}

}  // namespace mpm::idl
