#include "core/identification/identify_readings.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identification/identify_long.hpp"
#include "tests/core/identification/loop.hpp"

namespace mpm::identify_readings_test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using test::answer_of;

constexpr Index kRows = 6000;

/// CV 0 is read every so many samples.
Recording analysed(double every, std::uint64_t seed = 700) {
  Recording recording = test::open_loop(kRows, seed);
  const VectorXd measured = recording.cvs.col(0);
  double reading = measured(0);
  for (Index k = 1; k < kRows; ++k) {
    const auto now = static_cast<double>(k);
    if (std::floor(now / every) > std::floor((now - 1.0) / every)) reading = measured(k);
    recording.cvs(k, 0) = reading;
  }
  return recording;
}

}  // namespace

// The plant of `open_loop`: to CV 0 from input 0 gain 2, 12 samples, dead time 4; from input 2
// -0.5 and 30 samples; nothing from input 1.
TEST_CASE("a CV that is read seldom is identified by its readings, in the unit's own numbers") {
  const double every = GENERATE(4.0, 6.3, 10.0);
  const Recording recording = analysed(every);
  const Identification found = identify_long(recording, {}).identification;
  CHECK(found.cvs[0].read_every == static_cast<Index>(every));
  CHECK(found.cvs[0].cv == 0);
  const ChannelAnswer &first = answer_of(found, 0, 0), &third = answer_of(found, 0, 2);
  REQUIRE(first.left_out == LeftOut::kIdentified);
  REQUIRE(third.left_out == LeftOut::kIdentified);
  CHECK(answer_of(found, 0, 1).left_out == LeftOut::kNoRelation);
  CHECK(first.cv == 0);
  CHECK(first.dynamics->gain == Approx(2.0).epsilon(0.05));
  CHECK(third.dynamics->gain == Approx(-0.5).epsilon(0.1));
  // 95 % intervals: all of them are to hold the truth within twice their width.
  const auto covers = [](const Interval95& interval, double truth) {
    const double half = 0.5 * (interval.high - interval.low);
    return std::abs(truth - interval.low - half) < 2.0 * half;
  };
  CAPTURE(every, first.dynamics->time_constants_s[0], first.dynamics->dead_time_s,
          third.dynamics->time_constants_s[0]);
  CHECK(covers(first.gain, 2.0));
  CHECK(covers(first.time_constants.at(0), 12.0));
  CHECK(covers(first.dead_time_s, 4.0));
  CHECK(covers(third.gain, -0.5));
  CHECK(covers(third.time_constants.at(0), 30.0));
  // Where the CV stands with the inputs where they stand: as when every sample is measured.
  const Identification all = identify_long(test::open_loop(kRows, 700), {}).identification;
  CHECK(found.model.output_origin(0) == Approx(all.model.output_origin(0)).margin(0.3));
  REQUIRE(found.model.channels.size() == 3);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(found.model.channels[c].cv == all.model.channels[c].cv);
    CHECK(found.model.channels[c].input == all.model.channels[c].input);
  }
  CHECK(found.model.sample_time_s == recording.sample_time_s);
  // The other CV is what it would be without it.
  CHECK(answer_of(found, 1, 1).dynamics->gain ==
        Approx(answer_of(all, 1, 1).dynamics->gain).epsilon(0.01));
}

TEST_CASE("what is known of its channels beforehand is heeded") {
  IdentificationSettings settings;
  settings.hints = {{.cv = 1, .input = 1, .no_relation = true},
                    {.cv = 0, .input = 2, .no_relation = true}};
  const Identification found = identify_long(analysed(10.0), settings).identification;
  CHECK(answer_of(found, 0, 0).left_out == LeftOut::kIdentified);
  CHECK(answer_of(found, 0, 2).left_out == LeftOut::kGivenNone);
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kGivenNone);
}

TEST_CASE("too few readings stay left out, for that reason") {
  Recording recording = analysed(60.0);
  const Identification found = identify_long(recording, {}).identification;
  CHECK(answer_of(found, 0, 0).left_out == LeftOut::kReadSeldom);
  CHECK(found.cvs[0].read_every == 60);
  CHECK(answer_of(found, 1, 1).left_out == LeftOut::kIdentified);
}

}  // namespace mpm::identify_readings_test
