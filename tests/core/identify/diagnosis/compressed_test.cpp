#include "core/identify/diagnosis/compressed.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/output_disturbance.hpp"
#include "tests/core/counter_noise.hpp"

namespace mpm::compressed_test {
namespace {

constexpr Eigen::Index kRows = 3000;
constexpr double kDeadband = 0.1;

/// A slow CV with noise, s.d. about 0.7, as measured and as it is held until it has moved by a
/// deadband.
Recording recording_of(bool second_held, double deadband = kDeadband) {
  Recording recording;
  recording.cvs.resize(kRows, 2);
  double slow = 0.0, held = 0.0;
  for (Eigen::Index k = 0; k < kRows; ++k) {
    slow = 0.98 * slow + 0.2 * test::uniform(5, k);
    const double value = slow + 0.02 * test::uniform(6, k);
    if (std::abs(value - held) > deadband) held = value;
    recording.cvs(k, 0) = value;
    recording.cvs(k, 1) = second_held ? held : value;
  }
  return recording;
}

Finding found(const Cause& cause, int cv, double size) {
  Finding finding;
  finding.subject = {&cause, {.cv = cv}};
  finding.parameters = {{.quantity = &kSize, .value = size}};
  return finding;
}

TEST_CASE("only a disturbance that some deadbands could be is laid to compression") {
  const Compressed compressed(recording_of(true));
  CHECK(compressed.any());
  CHECK_FALSE(compressed.cv(0));
  REQUIRE(compressed.cv(1));
  const Cause& step = causes::step_disturbance();
  CHECK(compressed.may_have_made(found(step, 1, -2.0 * kDeadband)));
  CHECK_FALSE(compressed.may_have_made(found(step, 1, -4.0 * kDeadband)));
  CHECK_FALSE(compressed.may_have_made(found(step, 0, kDeadband)));
  CHECK_FALSE(compressed.may_have_made(found(causes::output_scale(), 1, 0.0)));
}

TEST_CASE("of a CV of which a deadband leaves hardly anything nothing may be named") {
  const Compressed compressed(recording_of(true, 0.6));
  REQUIRE(compressed.cv(1));
  CHECK(compressed.may_have_made(found(causes::step_disturbance(), 1, 10.0)));
  CHECK(compressed.may_have_made(found(causes::output_scale(), 1, 10.0)));
}

TEST_CASE("what is as it was measured is not laid to compression") {
  CHECK_FALSE(Compressed(recording_of(false)).any());
  CHECK_FALSE(Compressed().any());
}

}  // namespace
}  // namespace mpm::compressed_test
