#include "daemon/bus/trouble.hpp"

#include <catch2/catch.hpp>

namespace mpm::bus {

TEST_CASE("troubles stand the worst first, otherwise as they were found, and no text is endless") {
  std::vector<Trouble> troubles = {{"a", Severity::kMaintenanceRequired, "A"},
                                   {"b", Severity::kFailure, "B"},
                                   {"c", Severity::kOutOfSpecification, "C"},
                                   {"d", Severity::kFailure, "D"},
                                   {"e", Severity::kFunctionCheck, "E"}};
  sort_by_severity(troubles);
  CHECK(joined_text(troubles, 9) == "B; D; C; E; A");
  CHECK(joined_text(troubles, 2) == "B; D; 3 more");
  CHECK(joined_text({}, 2).empty());
}

TEST_CASE("severities have the words of NAMUR NE 107") {
  CHECK(std::string(to_string(Severity::kFailure)) == "failure");
  CHECK(std::string(to_string(Severity::kOutOfSpecification)) == "out_of_specification");
  CHECK(std::string(to_string(Severity::kFunctionCheck)) == "function_check");
  CHECK(std::string(to_string(Severity::kMaintenanceRequired)) == "maintenance_required");
}

TEST_CASE("of the alarms that stand those that are silenced are told apart") {
  CHECK(alarms_text(0, 0) == "0 alarms");
  CHECK(alarms_text(2, 0) == "2 alarms");
  CHECK(alarms_text(2, 1) == "1 alarm, 1 silenced");
  CHECK(alarms_text(2, 2) == "2 silenced alarms");
  CHECK(troubles_in("a; 1 alarm, 1 silenced", 2, 1) == "a");
  CHECK(troubles_in("1 silenced alarm; a", 1, 1) == "a");
  CHECK(troubles_in("1 silenced alarm", 1, 1).empty());
}

TEST_CASE("alarms and missing data are no troubles of a monitor, what follows them is") {
  CHECK(troubles_in("1 alarm", 1).empty());
  CHECK(troubles_in("no complete data yet", 0).empty());
  CHECK(troubles_in("nothing determined yet", 0).empty());
  CHECK(troubles_in("5 alarms; the journal cannot be written: a; b", 5) ==
        "the journal cannot be written: a; b");
  CHECK(troubles_in("nothing on mpm/dv; a; 2 alarms", 2) == "nothing on mpm/dv; a");
  CHECK(troubles_in("no complete data yet; nothing on mpm/dv", 0) == "nothing on mpm/dv");
  CHECK(troubles_in("the journal cannot be written: a", 0) == "the journal cannot be written: a");
  CHECK(troubles_in("", 0).empty());
}

}  // namespace mpm::bus
