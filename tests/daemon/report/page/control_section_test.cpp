#include "daemon/report/page/control_section.hpp"

#include <catch2/catch.hpp>

#include "tests/idl/fixed_records.hpp"

namespace mpm::test::control_section_test {
namespace {

using Json = nlohmann::ordered_json;

TEST_CASE("how well a unit is controlled has units, times and, where it is not known, dashes") {
  const Json control = report::control_section(performance(), 60.0);
  CHECK(control["text"] ==
        "599 samples of the whole recording. The controller acts in 93.8 % of them.");
  CHECK(control["cvs"]["columns"] ==
        Json({"CV", "control error, s.d.", "outside limits", "60 s ahead", "90 min ahead"}));
  // The variance is 0.25.
  CHECK(control["cvs"]["rows"][0] == Json({"y1", "0.5 degC", "6.25 %", "0.1 (0.2)", "0.3 (0.7)"}));
  CHECK(control["cvs"]["rows"][1] == Json({"y2", "\u2013", "\u2013"}));
  CHECK(control["mvs"]["rows"][0] == Json({"u1", "1 %", "2 %", "0.75 %", "50 %"}));
  CHECK(control["mvs"]["rows"][1] == Json({"u2", "\u2013", "\u2013", "\u2013", "\u2013"}));
}

}  // namespace
}  // namespace mpm::test::control_section_test
