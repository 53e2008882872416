#include "daemon/http/kept_digests.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "daemon/history/journal.hpp"
#include "daemon/http/board.hpp"
#include "tests/daemon/history/sample_history.hpp"
#include "tests/system/process.hpp"

namespace mpm::http {
namespace {

using namespace std::chrono_literals;

// A sample a minute makes a digest each quarter of an hour.
TEST_CASE("the indices of before are those of the journal, of whole files and damaged ones") {
  const config::UnitConfig unit = test::minute_unit();
  const test::TemporaryFolder folder;
  const std::string place = folder.file("journal");
  constexpr std::int64_t kQuarter = 15 * 60 * test::kSecond;
  {
    history::Journal journal(unit, {place, "minute", 1'000'000'000});
    report::UnitMonitor monitor(unit);
    test::MinuteFrames frames;
    for (int k = 0; k < 40 * 15; ++k) {
      monitor.push(frames.next());
      journal.push(monitor);
    }
    journal.finish();
  }
  const std::string file = place + "/minute-000001.jsonl";
  const auto digests = [&] {
    int count = 0;
    for_each_kept_digest(place, "minute", 1'000'000'000,
                         [&count](const history::Digest&) { ++count; });
    return count;
  };
  CHECK(digests() == 40);
  Board board({unit}, place);
  board.start();
  const UnitStore& store = *board.find("minute");
  const auto until = Board::Clock::now() + 10s;
  while (store.draw_kpi(1000).times_s.size() < 40 && Board::Clock::now() < until)
    std::this_thread::sleep_for(1ms);
  const Drawing whole = store.draw_kpi(1000);
  CHECK(whole.times_s.size() == 40);
  CHECK(whole.times_s.front() ==
        Approx(static_cast<double>(test::kMonday + kQuarter - 60 * test::kSecond) * 1e-9));
  for_each_kept_digest(place, "minute", 10, [](const history::Digest&) { FAIL("too much"); });
  for_each_kept_digest(place, "another", 1'000'000, [](const history::Digest&) { FAIL("whose"); });
  for_each_kept_digest(place + "-not", "minute", 10, [](const history::Digest&) { FAIL("where"); });

  const std::string text = test::read_file(file);
  const std::size_t middle = text.find('\n', text.size() / 2) + 1;
  test::write_file(file, text.substr(0, middle) + "{torn\n" + text.substr(middle));
  CHECK(digests() > 10);
  CHECK(digests() < 30);
}

}  // namespace
}  // namespace mpm::http
