#include "daemon/bag/list_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::bag::list_text_test {
namespace {

constexpr std::int64_t kMinute = 60'000'000'000;
constexpr std::int64_t kStart = 1'714'564'800'000'000'000;  // 2024-05-01T12:00:00Z

std::vector<ListedRecording> two() {
  ListedRecording one{"monday.mcap", {"f/monday.mcap"},   kStart, kStart + 50 * kMinute, 508'500,
                      12'004,        {"boiler", "shell"}, ""};
  ListedRecording torn{"x\x1b.mcap", {"f/x\x1b.mcap"}, {}, {}, 12, 1, {}, "byte 7: cut off"};
  return {one, torn};
}

}  // namespace

TEST_CASE("a list is one line for each recording, in columns and fit for a terminal") {
  CHECK(to_text(two()) ==
        "monday.mcap  2024-05-01T12:00:00Z  50.0 min  508.5 kB  12004 messages  boiler,shell  "
        "whole\n"
        "x\\x1b.mcap   -                     -         12 bytes  1 message       -             "
        "NOT WHOLE: byte 7: cut off\n");
  CHECK(to_text(std::vector<ListedRecording>{}).empty());
}

TEST_CASE("a list for programs has what is known") {
  const auto json = to_json(two());
  REQUIRE(json.size() == 2);
  CHECK(json[0].dump() ==
        R"({"name":"monday.mcap","files":["f/monday.mcap"],"start":"2024-05-01T12:00:00Z",)"
        R"("end":"2024-05-01T12:50:00Z","duration_s":3000.0,"bytes":508500,"messages":12004,)"
        R"("units":["boiler","shell"],"whole":true})");
  CHECK_FALSE(json[1].contains("start"));
  CHECK(json[1]["whole"] == false);
  CHECK(json[1]["problem"] == "byte 7: cut off");
}

}  // namespace mpm::bag::list_text_test
