#include "daemon/report/diagnosis/other_row.hpp"

#include <catch2/catch.hpp>

namespace mpm::report::other_row_test {
namespace {

TEST_CASE("CVs that are a row off were logged the other way") {
  CHECK(other_row_name(OtherRow::kNone).empty());
  CHECK(other_row_text(OtherRow::kNone).empty());
  CHECK(other_row_name(OtherRow::kLater) == "a row later");
  CHECK(other_row_text(OtherRow::kEarlier).find("logged a row too late") != std::string::npos);
  CHECK(other_row_text(OtherRow::kLater).find("logged a row too early") != std::string::npos);
}

}  // namespace
}  // namespace mpm::report::other_row_test
