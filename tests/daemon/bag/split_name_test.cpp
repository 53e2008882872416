#include "daemon/bag/split_name.hpp"

#include <catch2/catch.hpp>
#include <tuple>

namespace mpm::bag {

TEST_CASE("files of a recording that was split have a stem and a number of four digits or more") {
  for (const auto& [name, stem, number] : {std::tuple{"monday-0001.mcap", "monday", 1},
                                           {"a-b-12345.mcap", "a-b", 12345},
                                           {"-0007.mcap", "", 7}}) {
    const std::optional<SplitName> found = split_name(name);
    REQUIRE(found);
    CHECK(found->stem == stem);
    CHECK(found->number == number);
  }
  for (const char* name : {"monday.mcap", "monday-001.mcap", "monday-0001x.mcap", "monday-0001",
                           "monday-0001.mcap.bak", "0001.mcap", "monday-1234567890.mcap"})
    CHECK_FALSE(split_name(name));
}

}  // namespace mpm::bag
