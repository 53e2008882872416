#include "daemon/app/commands/quantity.hpp"

#include <catch2/catch.hpp>

namespace mpm::app {
namespace {

/// What a validator makes of a text; the complaint where it refuses it.
std::string made(const CLI::Validator& validator, std::string text) {
  const std::string problem = validator(text);
  return problem.empty() ? text : "refused";
}

TEST_CASE("times are seconds, or have a unit") {
  CHECK(std::stod(made(time_value(), "90")) == 90.0);
  CHECK(std::stod(made(time_value(), "1.5h")) == 5400.0);
  CHECK(std::stod(made(time_value(), "5min")) == 300.0);
  CHECK(std::stod(made(time_value(), "0")) == 0.0);
  CHECK(made(positive_time_value(), "0") == "refused");
  for (const char* text : {"", "h", "-1", "5 parsecs", "nan", "inf", "1e999"})
    CHECK(made(time_value(), text) == "refused");
}

TEST_CASE("sizes are bytes, or have a unit, and are not too small") {
  CHECK(made(size_value(1), "1000") == "1000");
  CHECK(made(size_value(1), "1.5GB") == "1500000000");
  CHECK(made(size_value(1), "4KiB") == "4096");
  CHECK(made(size_value(1'000'000), "1kB") == "refused");
  CHECK(made(size_value(1), "much") == "refused");
}

}  // namespace
}  // namespace mpm::app
