#include "daemon/report/condensing/condensing_report.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {
namespace {

TEST_CASE("what was used of a long recording is told in a sentence and in numbers") {
  CHECK(condensing_text({}, 3000).empty());
  CHECK(condensing_text({.given = 1'200'000, .every = 10, .stretches = 8}, 40'000) ==
        "of 1200000 samples each 10 were averaged into one, and of these 8 stretches were taken in "
        "which most moves, 40000 samples together");
  CHECK(condensing_text({.given = 90'000, .every = 1, .stretches = 1}, 20'000) ==
        "of 90000 samples 1 stretch was taken in which most moves, 20000 samples together");
  const auto json = condensing_json({.given = 90'000, .every = 3, .stretches = 0});
  CHECK(json.dump() == R"({"samples_given":90000,"averaged":3,"stretches":0})");
}

}  // namespace
}  // namespace mpm::report
