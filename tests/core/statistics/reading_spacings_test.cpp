#include "core/statistics/reading_spacings.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace mpm::reading_spacings_test {
namespace {

/// So many times the same rows.
ReadingSpacings of(const std::vector<std::int64_t>& rows, int times = 8) {
  std::vector<std::int64_t> spacings;
  for (int i = 0; i < times; ++i) spacings.insert(spacings.end(), rows.begin(), rows.end());
  return reading_spacings(spacings);
}

}  // namespace

TEST_CASE("a cycle of whole rows, with readings that are equal or missing") {
  const ReadingSpacings found = of({5, 5, 10, 5, 15});
  CHECK(found.every == 5);
  CHECK(found.regular == 1.0);
  CHECK(found.mean == 5.0);
}

TEST_CASE("a cycle of no whole number of rows has two lengths") {
  CHECK(of({10, 10, 11, 10}).regular == 1.0);
  CHECK(of({10, 10, 11, 10}).mean == 10.25);
  CHECK(of({2, 3}).regular == 1.0);
  CHECK(of({2, 3}).mean == 2.5);
  CHECK(of({3, 3, 2, 3}).mean == 2.75);
}

TEST_CASE("a long cycle may come a row early or late, a short one may not") {
  CHECK(of({12, 11, 13}).regular == 1.0);
  CHECK(of({5, 4, 6}).regular < 0.9);
}

// A deadband's: of a cycle of two rows, two or three are nearly all there is.
TEST_CASE("rows of all lengths are no cycle, nor is every row") {
  CHECK(of({2, 4, 5, 7, 2, 3, 9, 2, 2, 11}).regular < 0.9);
  CHECK(of({3, 3, 4, 7, 10, 3, 13}).regular < 0.9);
  CHECK(of({1, 1, 2, 1, 1, 2}).regular < 0.9);
  CHECK(reading_spacings({}).regular == 0.0);
}

}  // namespace mpm::reading_spacings_test
