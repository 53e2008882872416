#include "core/alarm/condition.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace mpm {
namespace {

const Condition::Limits kLimits{1e-6, 1e-3, 3, 2};

// Feeds p-values and returns the 0-based positions where the state changed.
std::vector<int> changes(Condition& condition, const std::vector<double>& p_values) {
  std::vector<int> result;
  for (std::size_t i = 0; i < p_values.size(); ++i)
    if (condition.update(p_values[i], kLimits)) result.push_back(static_cast<int>(i));
  return result;
}

TEST_CASE("an alarm is raised after its on-delay and cleared after its off-delay") {
  Condition condition;
  CHECK(changes(condition, {1e-9, 1e-9, 1e-9, 1e-9, 0.5, 0.5, 0.5}) == std::vector<int>{2, 5});
  CHECK(condition.state() == AlarmState::kCleared);
}

TEST_CASE("an interruption starts the delay anew") {
  Condition condition;
  CHECK(changes(condition, {1e-9, 1e-9, 1e-5, 1e-9, 1e-9}).empty());
  CHECK(changes(condition, {1e-9}) == std::vector<int>{0});
}

TEST_CASE("between the limits nothing changes") {
  Condition condition;
  CHECK(changes(condition, std::vector<double>(50, 1e-5)).empty());
  CHECK(changes(condition, {1e-9, 1e-9, 1e-9}) == std::vector<int>{2});
  CHECK(changes(condition, std::vector<double>(50, 1e-5)).empty());
  CHECK(condition.state() == AlarmState::kActive);
}

TEST_CASE("without a verdict an alarm neither comes nor goes") {
  Condition condition;
  CHECK(changes(condition, {1e-9, 1e-9}).empty());
  condition.hold();
  CHECK(changes(condition, {1e-9, 1e-9}).empty());
  CHECK(changes(condition, {1e-9}) == std::vector<int>{0});
  CHECK(changes(condition, {0.5}).empty());
  condition.hold();
  CHECK(changes(condition, {0.5}).empty());
  CHECK(condition.state() == AlarmState::kActive);
}

}  // namespace
}  // namespace mpm
