#include "daemon/files/csv/sample_rows.hpp"

#include <catch2/catch.hpp>

using namespace mpm;
using namespace mpm::files;

namespace {

const SignalCounts kCounts{1, 0, 1, 0, 0};
const Slot kInput{SignalKind::kMv, 0}, kOutput{SignalKind::kCv, 0};

}  // namespace

TEST_CASE("Tags are sampled together as long as few rows are missing") {
  TagTimes times(kCounts);
  CHECK_FALSE(times.apart());
  for (int k = 0; k < 40; ++k) {
    times.add(kOutput, k);
    if (k % 5 != 4) times.add(kInput, k);  // at four of five
  }
  CHECK_FALSE(times.apart());
  CHECK(times.count() == 40);
  for (int k = 40; k < 60; ++k) times.add(kOutput, k);  // 32 of 60
  CHECK(times.apart());
}

TEST_CASE("A tag that comes late is measured from there") {
  TagTimes times(kCounts);
  for (int k = 0; k < 40; ++k) {
    times.add(kOutput, k);
    if (k >= 30) times.add(kInput, k);
  }
  CHECK_FALSE(times.apart());
}

TEST_CASE("Tags that are sampled one shortly after the other are nearly together") {
  TagTimes near(kCounts, 15), exact(kCounts);
  for (int k = 0; k < 40; ++k)
    for (TagTimes* times : {&near, &exact}) {
      times->add(kInput, 60 * k + k % 3);
      times->add(kOutput, 60 * k + 10 + k % 5);
    }
  CHECK_FALSE(near.apart());
  CHECK(near.count() == 40);
  CHECK(exact.apart());
  for (int k = 40; k < 80; ++k) {  // 20 later: a row each
    near.add(kInput, 60 * k);
    near.add(kOutput, 60 * k + 20);
  }
  CHECK(near.count() == 120);
}

TEST_CASE("A tag that comes twice within so much begins a row") {
  TagTimes near(kCounts, 15);
  for (int k = 0; k < 40; ++k) {
    near.add(kInput, 6 * k);
    near.add(kOutput, 6 * k);
  }
  CHECK(near.count() == 40);
}

TEST_CASE("Two tags in turn are apart") {
  TagTimes times(kCounts);
  for (int k = 0; k < 40; ++k) times.add(k % 2 == 0 ? kInput : kOutput, k);
  CHECK(times.apart());
}
