#include "core/identify/causes/finding.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace mpm {
namespace {

// The words of the reports' contract.
TEST_CASE("causes are called what the reports call them") {
  const std::pair<Cause, const char*> names[] = {
      {Cause::kGain, "gain"},
      {Cause::kDeadTime, "dead_time"},
      {Cause::kTimeConstant, "time_constant"},
      {Cause::kDynamics, "dynamics"},
      {Cause::kInputScale, "input_scale"},
      {Cause::kOutputScale, "output_scale"},
      {Cause::kInputNonlinearity, "input_nonlinearity"},
      {Cause::kStiction, "stiction"},
      {Cause::kOutputNonlinearity, "output_nonlinearity"},
      {Cause::kUnmodelledInput, "unmodelled_input"},
      {Cause::kOutputDisturbance, "output_disturbance"},
      {Cause::kNoise, "noise"},
      {Cause::kStateNonlinearity, "state_nonlinearity"},
      {Cause::kUnnamed, "unnamed"},
  };
  for (const auto& [cause, name] : names) CHECK(std::string(name_of(cause)) == name);
}

TEST_CASE("a subject is another where any of its parts is") {
  const Subject subject{Cause::kOutputDisturbance, 1, -1, -1, "step"};
  CHECK(subject == Subject{Cause::kOutputDisturbance, 1, -1, -1, "step"});
  CHECK_FALSE(subject == Subject{Cause::kNoise, 1, -1, -1, "step"});
  CHECK_FALSE(subject == Subject{Cause::kOutputDisturbance, 0, -1, -1, "step"});
  CHECK_FALSE(subject == Subject{Cause::kOutputDisturbance, 1, 0, -1, "step"});
  CHECK_FALSE(subject == Subject{Cause::kOutputDisturbance, 1, -1, 0, "step"});
  CHECK_FALSE(subject == Subject{Cause::kOutputDisturbance, 1, -1, -1, "drift"});
}

}  // namespace
}  // namespace mpm
