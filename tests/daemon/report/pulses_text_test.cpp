#include "daemon/report/pulses_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("pulses that no CV answers are told with their times, three of them at most") {
  config::UnitConfig unit;
  unit.mv.resize(1);
  unit.mv[0].tag = "FIC101.SP";
  Recording recording;
  recording.sample_time_s = 30.0;
  recording.start_s = 1'767'571'200.0;  // 2026-01-05 00:00:00 UTC
  recording.cvs.setZero(6000, 1);
  CHECK(pulses_text(unit, recording, {}, nullptr).empty());
  const Pulse pulse{0, 120, 1, 95.0, 39.9};
  CHECK(pulses_text(unit, recording, {pulse}, nullptr) ==
        "no CV answers FIC101.SP going from 39.9 to 95 and back at 01:00:00 on 5 January: it is "
        "taken as not known there");
  const std::string many =
      pulses_text(unit, recording, {pulse, pulse, pulse, pulse, pulse}, nullptr);
  CHECK(many.find(" and 2 more such jumps: they are taken as not known there") !=
        std::string::npos);
}

}  // namespace mpm::report
