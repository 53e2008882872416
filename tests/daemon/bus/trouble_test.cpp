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

}  // namespace mpm::bus
