#include "config/cli/number_value.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace mpm::cli {
namespace {

std::string problem(const CLI::Validator& validator, std::string text) { return validator(text); }

TEST_CASE("a number is finite and within its range, which is told in few words") {
  for (const char* text : {"0", "2.5", "1e3", "1e300"})
    CHECK(problem(number_value(0.0), text).empty());
  for (const std::string text : {"-1", "-1e-9", "nan", "inf", "-inf", "1e999", "x", "2x", ""})
    CHECK(problem(number_value(0.0), text) == "'" + text + "' is no number from 0 on");
  CHECK(problem(number_value(0.1, 1000.0), "0.1").empty());
  CHECK(problem(number_value(0.1, 1000.0), "1000").empty());
  CHECK(problem(number_value(0.1, 1000.0), "1001") == "'1001' is no number from 0.1 to 1000");
  CHECK(problem(number_value(0.1, 1000.0), "nan") == "'nan' is no number from 0.1 to 1000");
}

}  // namespace
}  // namespace mpm::cli
