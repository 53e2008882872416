#include "core/record/reason_text.hpp"

#include <catch2/catch.hpp>

namespace mpm {
namespace {

TEST_CASE("a reason names the signal it is about, where there is one") {
  CHECK(reason_text(Reason::kNone, "") == "");
  CHECK(reason_text(Reason::kNotExcited, "") == "not_excited");
  CHECK(reason_text(Reason::kCollinear, "TIC with 7") == "collinear with TIC with 7");
  CHECK(reason_text(Reason::kBadData, "") == "bad_data");
  CHECK(reason_text(Reason::kBadData, "u2") == "bad_data with u2");
}

}  // namespace
}  // namespace mpm
