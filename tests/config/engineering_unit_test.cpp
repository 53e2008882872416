#include "config/engineering_unit.hpp"

#include <catch2/catch.hpp>

namespace mpm::config {
namespace {

std::string read(const std::string& text) {
  const std::optional<EngineeringUnit> unit = EngineeringUnit::parse(text);
  return unit ? to_string(*unit) : "none";
}

TEST_CASE("units are products of powers of words, however they are written") {
  CHECK(read("m3/h") == "m3/h");
  CHECK(read("m^3/h") == "m3/h");
  CHECK(read("kJ/(kg K)") == "kJ/(K kg)");
  CHECK(read("kJ/kg/K") == "kJ/(K kg)");
  CHECK(read("kg.m.s^-2") == "kg m/s2");
  CHECK(read("W\xc2\xb7h") == "W h");
  CHECK(read("\xc2\xb0"
             "C") ==
        "\xc2\xb0"
        "C");
  CHECK(read("%") == "%");
  CHECK(read("1/s") == "1/s");
  CHECK(read("-") == "1");
  CHECK(read("m/m") == "1");
  CHECK(EngineeringUnit::parse("m3 / h") == EngineeringUnit::parse("h^-1*m^3"));
  CHECK_FALSE(EngineeringUnit::parse("kW") == EngineeringUnit::parse("kJ/s"));
}

TEST_CASE("what is not written so has no unit") {
  for (const std::string text : {"", "m^", "m/", "/h", "(m", "m)", "10 m", "t/h [dry]", "m^1000"}) {
    CAPTURE(text);
    CHECK(read(text) == "none");
  }
  CHECK(read(std::string(10000, '(')) == "none");
}

}  // namespace
}  // namespace mpm::config
