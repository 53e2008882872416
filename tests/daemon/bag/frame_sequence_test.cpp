#include "daemon/bag/frame_sequence.hpp"

#include <catch2/catch.hpp>

#include "daemon/bag/open_recording.hpp"
#include "tests/daemon/bag/bench.hpp"

namespace mpm::test {
namespace {

/// Rows of the small unit from one minute to before another.
std::string rows(int first, int end) {
  std::string text = "time,u,\"d,1\",y,z,yhat,sp\n";
  for (int k = first; k < end; ++k)
    text += std::to_string(60 * k) + "," + std::to_string(k) + ",1,2,3,4,5\n";
  return text;
}

std::vector<std::pair<std::int64_t, double>> read(files::FrameSource& source,
                                                  const config::UnitConfig& unit) {
  std::vector<std::pair<std::int64_t, double>> frames;  // interval, u
  Frame frame(unit.counts());
  while (source.next(frame)) frames.emplace_back(frame.interval, frame[SignalKind::kMv].values(0));
  return frames;
}

TEST_CASE("several files are one history, in the order of their time") {
  Bench bench;
  const auto file = [&](const std::string& name) { return bench.folder.file(name); };
  write_file(file("c.csv"), rows(0, 40));
  write_file(file("a.csv"), rows(30, 60));  // ten rows twice
  write_file(file("b.csv"), rows(75, 90));  // behind a gap
  static_cast<void>(bench.convert("b.csv", "b.mcap", bench.with_unit()));
  write_file(file("all.csv"), rows(0, 60) + rows(75, 90).substr(rows(0, 0).size()));

  const auto whole = bag::open_recording(file("all.csv"), bench.unit);
  const auto expected = read(*whole, bench.unit);
  REQUIRE(expected.size() == 75);
  const std::string last = GENERATE("b.csv", "b.mcap");
  const auto parts = bag::open_recording({file("a.csv"), file(last), file("c.csv")}, bench.unit);
  CHECK(read(*parts, bench.unit) == expected);
  CHECK(parts->share_read() == 1.0);
  REQUIRE_FALSE(parts->notices().empty());
  CHECK(std::find(parts->notices().begin(), parts->notices().end(),
                  file("a.csv") + ": 10 rows left out that other files hold already") !=
        parts->notices().end());
}

TEST_CASE("an error in one of several files is told at its place") {
  Bench bench;
  write_file(bench.folder.file("a.csv"), rows(0, 300));
  write_file(bench.folder.file("b.csv"), rows(300, 600) + "36000,x1.2.3,12..,1,1,1,1\n");
  const auto parts =
      bag::open_recording({bench.folder.file("a.csv"), bench.folder.file("b.csv")}, bench.unit);
  CHECK_THROWS_WITH(read(*parts, bench.unit),
                    Catch::StartsWith(bench.folder.file("b.csv") + ":302:"));
}

}  // namespace
}  // namespace mpm::test
