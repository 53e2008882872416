#include "daemon/files/csv/line_frames.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "config/finding.hpp"
#include "config/load_unit.hpp"

using namespace mpm;
using namespace mpm::files;

namespace {

std::int64_t first_time_ns(const std::string& text, const TimeStyle& times) {
  const auto loaded = config::load_unit_text(
      "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: y1}\n"
      "model: {channels: [{cv: y1, mv: u1, gain: 1}]}\n",
      "u.yaml");
  REQUIRE(loaded.ok());
  LineFrames lines(std::make_unique<std::istringstream>(text), "stdin", LineFormat::kAuto,
                   loaded.config, times);
  Frame frame;
  const bool there = lines.next(frame);  // may throw what a test waits for
  REQUIRE(there);
  CHECK(frame[SignalKind::kMv].values(0) == 1.5);
  return frame.source_time_ns;
}

}  // namespace

TEST_CASE("Lines tell times as data files do") {
  const TimeStyle berlin{std::make_shared<TimeZone>("Europe/Berlin"), nullptr};
  const std::int64_t noon_ns = 1'714'564'800'000'000'000;  // date -u -d 2024-05-01T12:00:00Z +%s
  CHECK(first_time_ns("time,u1,y1\n01.05.2024 14:00:00,1.5,2\n", berlin) == noon_ns);
  CHECK(first_time_ns("{\"time\": \"2024-05-01 14:00:00\", \"u1\": 1.5}\n", berlin) == noon_ns);
  CHECK(first_time_ns("{\"time\": 1714564800000, \"u1\": 1.5}\n", {}) == noon_ns);
  const TimeStyle odd{berlin.zone, std::make_shared<TimeFormat>("%H:%M %d.%m.%y")};
  CHECK(first_time_ns("time,u1,y1\n14:00 01.05.24,1.5,2\n", odd) == noon_ns);
  CHECK_THROWS_WITH(first_time_ns("time,u1,y1\n01.05.2024 14:00:00,1.5,2\n", {}),
                    Catch::Contains("--time-zone"));
  CHECK_THROWS_WITH(first_time_ns("{\"time\": 1, \"u1\": 2.5, \"u1\": 1.5}\n", {}),
                    "stdin:1:19: error: 'u1' is given twice");
  CHECK(first_time_ns("{\"time\": 1, \"u1\": 1.5, \"x\": {\"u1\": 3, \"time\": 4}}\n", {}) ==
        1'000'000'000);
  CHECK_THROWS_WITH(first_time_ns("u1,y1\n1.5,2\n", {}),
                    Catch::Contains("the first column must be `time`, not 'u1'"));
}
