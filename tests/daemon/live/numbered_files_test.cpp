#include "daemon/live/numbered_files.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/system/process.hpp"

namespace mpm::live {
namespace {

TEST_CASE("files of a series are found by their number, and nobody else's") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("series");
  CHECK(numbers_in(place, "state-").empty());
  std::filesystem::create_directory(place);
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t number : {std::uint64_t{10}, std::uint64_t{9}, kLast})
    test::write_file(numbered_path(place, "state-", number), "");
  for (const char* other : {"state-", "state-9", "state-00000000000x", "state-000000000009.old",
                            "samples-000000000003", "state-99999999999999999999999"})
    test::write_file(place + "/" + other, "");
  CHECK(numbers_in(place, "state-") == std::vector<std::uint64_t>{9, 10, kLast});
  CHECK(numbers_in(place, "samples-") == std::vector<std::uint64_t>{3});
}

}  // namespace
}  // namespace mpm::live
