#include "core/identify/causes/finding.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"

namespace mpm {
namespace {

TEST_CASE("a subject is another where any of its parts is") {
  const Subject subject{&causes::step_disturbance(), {1}};
  CHECK(subject == Subject{&causes::step_disturbance(), {1, -1, -1}});
  CHECK_FALSE(subject == Subject{&causes::noise(), {1, -1, -1}});
  CHECK_FALSE(subject == Subject{&causes::step_disturbance(), {0, -1, -1}});
  CHECK_FALSE(subject == Subject{&causes::step_disturbance(), {1, 0, -1}});
  CHECK_FALSE(subject == Subject{&causes::step_disturbance(), {1, -1, 0}});
  CHECK_FALSE(subject == Subject{&causes::drift_disturbance(), {1, -1, -1}});
}

// The words of the reports' contract.
TEST_CASE("a parameter has its quantity's name, and a number where there are several") {
  constexpr Quantity kOverflow{"overflow", Form::kPlain, Unit::kNone};
  CHECK(Parameter{&kGainRatio, 1.2, 1.1, 1.3}.name() == "gain_ratio");
  CHECK(Parameter{&kOverflow, 1.5, 1.4, 1.6, 1}.name() == "overflow_1");
  CHECK(Parameter{&kOverflow, 1.5, 1.4, 1.6, 12}.name() == "overflow_12");
}

TEST_CASE("a finding knows its numbers by their quantity, not by its name") {
  constexpr Quantity kLike{"gain_ratio", Form::kPlain, Unit::kOfModel};
  Finding finding;
  finding.parameters = {{&kDeadTimeError, 3.0, 2.0, 4.0}, {&kGainRatio, 1.2, 1.1, 1.3}};
  REQUIRE(finding.find(kGainRatio) != nullptr);
  CHECK(finding.find(kGainRatio)->value == 1.2);
  CHECK(finding.find(kLike) == nullptr);
}

}  // namespace
}  // namespace mpm
