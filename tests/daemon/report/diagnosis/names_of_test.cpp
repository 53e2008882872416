#include "daemon/report/diagnosis/names_of.hpp"

#include <catch2/catch.hpp>

#include "core/identify/causes/catalog.hpp"

namespace mpm::report {

TEST_CASE("what is only in the model together with its like is not said to need itself") {
  SignalNames names;
  names.inputs = {{"u1", ""}, {"u2", ""}};
  names.cvs = {{"y1", ""}};
  Finding finding;
  finding.subject = {causes::all().front(), {0, 0, -1}};
  finding.with = Subject{causes::all().front(), {0, 1, -1}};
  CHECK(needed_text(names, finding) == names.subject(*finding.with));
  finding.with = finding.subject;
  CHECK(needed_text(names, finding) == "the other " + names.subject(finding.subject));
}

}  // namespace mpm::report
