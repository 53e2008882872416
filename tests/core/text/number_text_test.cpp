#include "core/text/number_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm {
namespace {

// All by hand.
TEST_CASE("a time is told in the largest unit that leaves it whole") {
  CHECK(duration_text(86400.0) == "1 d");
  CHECK(duration_text(28800.0) == "8 h");
  CHECK(duration_text(5400.0) == "90 min");
  CHECK(duration_text(61.0) == "61 s");
  CHECK(duration_text(0.0) == "0 s");
  CHECK(duration_text(1e300) != "");
}

TEST_CASE("numbers read as people write them") {
  CHECK(number_text(0.25) == "0.25");
  CHECK(number_text(-0.0) == "0");
  CHECK(number_text(1234.5) == "1234");
  CHECK(number_text(812.0, 6) == "812");
  CHECK(number_text(2.0e-9) == "2e-09");
  CHECK(number_text(std::nan("")) == "-");
}

TEST_CASE("intervals and shares read as people write them") {
  CHECK(interval_text(0.72, 0.78) == "0.72 to 0.78");
  CHECK(interval_text(-4.0, 1.23456, 2) == "-4 to 1.2");
  CHECK(interval_text(1.4998, 1.5003) == "1.4998 to 1.5003");
  CHECK(interval_text(1.5, 1.5) == "1.5 to 1.5");
  CHECK(interval_text(1.67e-15, 19.4) == "0 to 19.4");
  CHECK(interval_text(-2e4, -1e-13) == "-20000 to 0");
  CHECK(interval_text(1e-9, 19.4) == "1e-09 to 19.4");
  CHECK(interval_text(1e-15, 2e-15) == "1e-15 to 2e-15");
  CHECK(interval_text(1.0, 1.0 + 1e-12) == "1 to 1");
  CHECK(percent_text(0.25) == "25 %");
  CHECK(percent_text(0.004) == "0.4 %");
  CHECK(percent_text(0.1234) == "12 %");
  CHECK(percent_text(0.1234, 3) == "12.3 %");
}

TEST_CASE("nothing is certain") {
  CHECK(confidence_text(0.95) == "0.95");
  CHECK(confidence_text(0.954) == "0.95");
  CHECK(confidence_text(0.9962) == "0.996");
  CHECK(confidence_text(0.999) == "0.999");
  CHECK(confidence_text(0.9995) == "> 0.999");
  CHECK(confidence_text(1.0) == "> 0.999");
  CHECK(sure_text(0.954) == "95 %");
  CHECK(sure_text(0.9962) == "99.6 %");
  CHECK(sure_text(0.999) == "99.9 %");
  CHECK(sure_text(1.0) == "> 99.9 %");
}

}  // namespace
}  // namespace mpm
