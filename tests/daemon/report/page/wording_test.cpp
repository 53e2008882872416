#include "daemon/report/page/wording.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test::wording_test {
namespace {

using namespace mpm::report;

const double kNaN = std::nan("");

TEST_CASE("a number has the digits that its interval knows") {
  CHECK(rounded(1.40213, 1.3812, 1.4243) == "1.402");
  CHECK(interval(1.40213, 1.3812, 1.4243) == "1.381 to 1.424");
  CHECK(rounded(7.2, 5.0, 9.4, "degC") == "7.2 degC");
  CHECK(rounded(-23922.0, -30316.0, -18877.0, "s") == "\u221223900 s");
  CHECK(rounded(0.0, -1.0, 1.0) == "0.0");
  CHECK(rounded(-0.001, -1.0, 1.0) == "0.0");               // no minus before 0
  CHECK(rounded(0.074189, 0.07342, 0.07495) == "0.07419");  // a power of ten only below 0.001
  CHECK(rounded(10.0, 9.9999999, 10.0) == "10.000");        // five digits are enough
}

TEST_CASE("a number without an interval has three digits") {
  CHECK(rounded(7.2) == "7.2");
  CHECK(rounded(0.04056) == "0.0406");
  CHECK(rounded(0.0) == "0");
  CHECK(rounded(123456.0) == "123000");
  CHECK(rounded(3.25e-6) == "3.25\u00b710\u207b\u2076");
  CHECK(rounded(-4.5e9) == "\u22124.50\u00b710\u2079");
  CHECK(rounded(kNaN) == "\u2013");
  CHECK(interval(1.0, kNaN, 2.0).empty());
}

TEST_CASE("durations are in the unit in which they are read") {
  CHECK(duration(14.0, 13.0, 15.0) == "14.0 s");
  CHECK(duration(840.0) == "14 min");
  CHECK(duration(23922.0, 18877.0, 30316.0) == "6.6 h");
  CHECK(duration_interval(23922.0, 18877.0, 30316.0) == "5.2 to 8.4");
  CHECK(duration(4'500'000.0) == "52.1 days");
  CHECK(duration(0.0) == "0 s");
  CHECK(duration(-0.25) == "\u22120.25 s");
}

TEST_CASE("odds are said in words, defined once") {
  CHECK(likelihood(0.9999) == std::string("all but certain"));
  CHECK(likelihood(0.99) == std::string("all but certain"));
  CHECK(likelihood(0.95) == std::string("very likely"));
  CHECK(likelihood(0.7) == std::string("likely"));
  CHECK(likelihood(0.5) == std::string("unsure"));
  CHECK(likelihood(0.0) == std::string("unlikely"));
  CHECK(likelihood_legend() ==
        "all but certain: from 99 %, very likely: from 90 %, likely: from 70 %, unsure: from 10 %, "
        "unlikely: less");
}

TEST_CASE("moments are dates in the zone of the data, or time on its own clock") {
  constexpr double kNewYear = 1767225600.0;  // 2026-01-01T00:00:00Z
  const Clock utc(kNewYear, 60.0, nullptr);
  CHECK(utc.at(kNewYear) == "1 Jan 2026 00:00");
  CHECK(utc.zone() == "UTC");
  const Clock berlin(kNewYear, 1.0, std::make_shared<files::TimeZone>("Europe/Berlin"));
  CHECK(berlin.between(kNewYear, kNewYear + 61.0) ==
        "1 Jan 2026 01:00:00 to 1 Jan 2026 01:01:01 (Europe/Berlin)");
  const Clock run(0.0, 1.0, nullptr);
  CHECK(run.at(7200.0) == "2 h");
  CHECK(run.zone().empty());
}

}  // namespace
}  // namespace mpm::test::wording_test
