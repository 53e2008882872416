#include "core/identify/diagnosis/confirmation.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"
#include "tests/core/identify/small_plant.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::lag;

constexpr Index kRows = 1500;

/// The input's part of what a model gets wrong, in shares of the channel: before and after.
Confirmation says(const Cause& cause, double before, double after) {
  const ModelSpec model = test::model_of({lag(0, 0, 2.0, 10.0)}, 1, 1);
  const VectorXd u = test::telegraph(1, kRows, 12);
  const VectorXd response = test::first_order(u, 2.0, 10.0);
  const auto tests = [&](double share) {
    const VectorXd residual = share * response + 0.1 * test::normal(3, kRows);
    return ChannelTests(model, test::recording_of(u, residual), residual);
  };
  Effect effect;
  effect.edit = &cause;
  effect.place = {0, 0};
  return confirmation(effect, model, 1, tests(before), tests(after));
}

TEST_CASE("a repair is borne out by as much as goes") {
  CHECK(says(causes::gain(), 0.5, 0.0) == Confirmation::kNothingOfAll);
  CHECK(says(causes::gain(), 0.5, 0.2) == Confirmation::kLess);
  CHECK(says(causes::gain(), 0.5, 0.5) == Confirmation::kNone);
  CHECK(says(causes::gain(), 0.3, 0.5) == Confirmation::kNone);
}

TEST_CASE("where the test saw nothing there is nothing to bear out") {
  CHECK(says(causes::gain(), 0.0, 0.3) == Confirmation::kLess);
}

TEST_CASE("a stuck actuator leaves nothing that answers it") {
  CHECK(says(causes::input_stuck(), 0.5, 0.0) == Confirmation::kNothing);
  CHECK(says(causes::input_stuck(), 0.5, 0.2) == Confirmation::kNone);
}

TEST_CASE("a sticking valve's shape says enough") {
  CHECK(says(causes::stiction(), 0.5, 0.6) == Confirmation::kNothing);
}

}  // namespace
}  // namespace mpm
