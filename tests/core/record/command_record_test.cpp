#include "core/record/command_record.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/idl/fixed_records.hpp"

namespace mpm {
namespace {

using test::command;

// Written by hand after D. J. Bernstein's definition of netstrings.
TEST_CASE("what is signed is the fields in their order, each with its length") {
  CHECK(signed_text(command()) ==
        "5:shell,2:u1,2:y1,6:shelve,5:28800,1:1,3:ann,5:panel,6:3:abc,,4:4711,7:1234567,");
  CHECK(signed_text({}) == "0:,0:,0:,0:,1:0,1:0,0:,0:,0:,0:,1:0,");
}

TEST_CASE("no two commands that differ are signed alike") {
  std::set<std::string> texts = {signed_text(command())};
  const auto differs = [&](auto change) {
    CommandRecord record = command();
    change(record);
    return texts.insert(signed_text(record)).second;
  };
  CHECK(differs([](CommandRecord& r) { r.unit = "shel"; }));
  CHECK(differs([](CommandRecord& r) { r.mv = "u1y1", r.cv = ""; }));
  CHECK(differs([](CommandRecord& r) { r.mv = "", r.cv = "u1y1"; }));
  CHECK(differs([](CommandRecord& r) { r.action = "unshelve"; }));
  CHECK(differs([](CommandRecord& r) { r.duration_s = 28801; }));
  CHECK(differs([](CommandRecord& r) { r.once = false; }));
  CHECK(differs([](CommandRecord& r) { r.user = "bob"; }));
  CHECK(differs([](CommandRecord& r) { r.host = ""; }));
  CHECK(differs([](CommandRecord& r) { r.comment = ""; }));
  CHECK(differs([](CommandRecord& r) { r.id = "di"; }));
  CHECK(differs([](CommandRecord& r) { r.time_ns = 8; }));
  CHECK_FALSE(differs([](CommandRecord& r) { r.proof = ""; }));
}

}  // namespace
}  // namespace mpm
