#include "daemon/files/csv/held_rows.hpp"

#include "tests/daemon/files/csv/reading.hpp"

using namespace mpm;
using namespace mpm::files;
using namespace mpm::files::test;

namespace {

/// A row only where a tag changed: y1 each second but from 10 to 12, u1 at 5 and 15; u2 is lost
/// from 8 until 10.
std::string changes(bool by_tag) {
  std::vector<std::pair<int, std::string>> rows = {{0, "u1,0,1"}, {5, "u1,5,2"},   {15, "u1,15,3"},
                                                   {0, "u2,0,5"}, {8, "u2,8,Bad"}, {10, "u2,10,6"}};
  for (int k = 0; k < 25; ++k)
    if (k < 10 || k > 12)
      rows.emplace_back(k, "y1," + std::to_string(k) + "," + std::to_string(10 + k));
  if (!by_tag)
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string text = "tag,time,value\n";
  for (const auto& [time, row] : rows) text += row + '\n';
  return text;
}

}  // namespace

TEST_CASE("Where a tag has a row only when it changed, it is held until the next one") {
  CsvReader csv = reader(changes(GENERATE(false, true)));
  CHECK(says(csv, "held from one to the next"));
  const std::vector<Frame> frames = frames_of(std::move(csv));
  REQUIRE(frames.size() == 25);
  for (int k = 0; k < 25; ++k) {
    CAPTURE(k);
    const Frame& frame = frames[static_cast<std::size_t>(k)];
    CHECK(frame.interval == k);
    CHECK(mv(frame, 0) == Approx(k < 5 ? 1 : k < 15 ? 2 : 3));
    const bool lost = k == 8 || k == 9;
    CHECK((frame[SignalKind::kMv].quality[1] == Quality::kBad) == lost);
    if (!lost) CHECK(mv(frame, 1) == Approx(k < 8 ? 5 : 6));
    CHECK(frame[SignalKind::kCv].values(0) == (k < 10 || k > 12 ? 10 + k : 19));
  }
}

TEST_CASE("A recording takes what is held, one row for each interval") {
  CsvReader csv(std::make_unique<std::istringstream>(changes(false)), "d.csv", unit(), {},
                Purpose::kKeep);
  const std::vector<Frame> frames = frames_of(std::move(csv));
  REQUIRE(frames.size() == 25);
  CHECK(mv(frames[14], 0) == 2);
  CHECK(mv(frames[15], 0) == 3);
  CHECK(frames[12][SignalKind::kCv].values(0) == 19);
}

TEST_CASE("Where no tag had a row for long, nothing is held") {
  std::string text = changes(false);
  for (int k = 0; k < 3; ++k) text += "y1," + std::to_string(8000 + k) + ",1\n";
  const std::vector<Frame> frames = frames_of(text);
  REQUIRE(frames.size() == 28);
  CHECK(frames[24].interval == 24);
  CHECK(frames[25].interval == 8000);
  CHECK(mv(frames[25], 0) == Approx(3));  // set before
}
