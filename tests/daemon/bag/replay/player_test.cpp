#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/bag/replay/mcap_source.hpp"
#include "daemon/bag/replay/player.hpp"
#include "daemon/bag/replay/selection.hpp"
#include "daemon/mcap/format/encode.hpp"
#include "tests/system/process.hpp"

namespace mpm::bag::player_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class FakeClock : public host::Clock {
 public:
  [[nodiscard]] std::int64_t now() const override { return now_; }
  void sleep_until(std::int64_t time) override { now_ = std::max(now_, time); }

 private:
  std::int64_t now_ = 1000 * kSecond;
};

// mpm::Sample as plain little-endian CDR, without values.
std::vector<std::byte> sample_bytes(const std::string& unit, std::int64_t interval,
                                    std::int64_t time_ns) {
  std::vector<std::byte> bytes = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  const auto add = [&](const void* data, std::size_t size) {
    while (size == 8 && (bytes.size() - 4) % 8 != 0) bytes.push_back(std::byte{0});
    const auto* begin = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  const auto length = static_cast<std::uint32_t>(unit.size() + 1);
  add(&length, sizeof length);
  for (const char c : unit) bytes.push_back(static_cast<std::byte>(c));
  bytes.push_back(std::byte{0});
  add(&interval, sizeof interval);
  add(&time_ns, sizeof time_ns);
  return bytes;
}

// One sample of mpm/mv per second of unit a, with one of unit b half a second later.
class FakeSource : public ReplaySource {
 public:
  explicit FakeSource(int seconds) : seconds_(seconds) {}
  [[nodiscard]] bool next(ReplaySample& sample) override {
    if (at_ == 2 * seconds_) return false;
    const int k = at_ / 2;
    const bool second = at_++ % 2 == 1;
    bytes_ = sample_bytes(second ? "b" : "a", k, k * kSecond);
    sample.topic = "mpm/mv";
    sample.log_time_ns = 50 * kSecond + k * kSecond + (second ? kSecond / 2 : 0);
    sample.source_time_ns = sample.log_time_ns - 1000;
    sample.cdr = bytes_;
    return true;
  }
  void rewind() override { at_ = 0; }

 private:
  int seconds_;
  int at_ = 0;
  std::vector<std::byte> bytes_;
};

using Times = std::vector<std::int64_t>;

struct Sent {
  std::int64_t at_ms;  // since the start, by the clock
  std::string unit;
  std::int64_t interval;
  std::int64_t source_time_ns;
};

// Plays with keys that are pressed when so many samples have been sent.
struct Stage {
  FakeClock clock;
  std::int64_t start = clock.now();
  std::vector<Sent> sent;
  std::deque<std::pair<std::uint64_t, Key>> keys;
  std::uint64_t most = 1000;
  PlayerState last;

  void play(ReplaySource& source, const PlayerOptions& options) {
    Player player(
        source, clock, options,
        [this](const ReplaySample& sample, std::int64_t time_ns, const idl::SampleChange& change) {
          const std::string unit = change.unit.empty() ? idl::unit_of(sample.cdr) : change.unit;
          sent.push_back({(clock.now() - start) / 1'000'000, unit,
                          idl::stamp_of(sample.cdr)->interval + change.add_intervals, time_ns});
          return true;
        },
        [this](const PlayerState& state) {
          if (state.samples >= most) return Key::kQuit;
          if (keys.empty() || state.samples < keys.front().first) return Key::kNone;
          const Key key = keys.front().second;
          keys.pop_front();
          return key;
        });
    CHECK(player.play());
    last = player.state();
  }
  /// ms since the start, by the clock.
  [[nodiscard]] Times times() const {
    Times list;
    for (const Sent& sample : sent) list.push_back(sample.at_ms);
    return list;
  }
};

}  // namespace

TEST_CASE("a replay keeps the recorded distances, times the rate") {
  FakeSource source(3);
  Stage real, fast, none;
  real.play(source, {});
  CHECK(real.times() == Times{0, 500, 1000, 1500, 2000, 2500});
  CHECK(real.sent[3].source_time_ns == 51'500'000'000 - 1000);  // as recorded
  source.rewind();
  PlayerOptions options;
  options.rate = 100.0;
  fast.play(source, options);
  CHECK(fast.times() == Times{0, 5, 10, 15, 20, 25});
  source.rewind();
  options.rate = 0.0;
  none.play(source, options);
  CHECK(none.times() == Times(6, 0));
}

TEST_CASE("a replay starts and ends where it is told and keeps to one unit") {
  FakeSource source(10);
  Stage stage;
  PlayerOptions options;
  options.start_offset_ns = 2 * kSecond;
  options.duration_ns = 3 * kSecond;
  options.unit = "b";
  options.remap = {{"b", "copy"}};
  stage.play(source, options);
  REQUIRE(stage.sent.size() == 3);
  CHECK(stage.times() == Times{0, 1000, 2000});
  CHECK(stage.sent[0].interval == 2);
  CHECK(stage.sent[0].unit == "copy");
}

TEST_CASE("a replay ends at a moment, of the recording or of the clock, whichever is first") {
  FakeSource source(10);  // one sample each half second from 50 s on
  const auto count = [&](const PlayerOptions& options) {
    Stage stage;
    stage.play(source, options);
    source.rewind();
    return stage.sent.size();
  };
  PlayerOptions options;
  options.end_offset_ns = 4 * kSecond;
  CHECK(count(options) == 8);
  options.start_offset_ns = 3 * kSecond;  // does not move the end
  CHECK(count(options) == 2);
  options.end_ns = 53 * kSecond + kSecond / 2;
  CHECK(count(options) == 1);
  options.end_ns = 60 * kSecond;
  CHECK(count(options) == 2);
}

TEST_CASE("a delay comes before every pass, and can be quit") {
  FakeSource source(1);  // samples at 0 and 0.5 s
  Stage stage;
  PlayerOptions options;
  options.delay_ns = 3 * kSecond;
  options.loop = true;
  stage.most = 4;
  stage.play(source, options);
  CHECK(stage.times() == Times{3000, 3500, 6500, 7000});
  source.rewind();
  Stage quit;
  quit.keys = {{0, Key::kQuit}};
  quit.play(source, options);
  CHECK(quit.sent.empty());
  CHECK(quit.clock.now() - quit.start < kSecond);
}

TEST_CASE("keys pause, step, change the speed and quit") {
  FakeSource source(10);
  Stage stage;
  stage.keys = {{2, Key::kPause}, {2, Key::kStep},   {3, Key::kStep},
                {4, Key::kPause}, {4, Key::kFaster}, {6, Key::kSlower}};
  stage.most = 8;
  stage.play(source, {});
  // 0 and 1 in time, 2 and 3 by hand at once, then twice the speed, then real time again.
  CHECK(stage.times() == Times{0, 500, 500, 500, 750, 1000, 1500, 2000});
  CHECK(stage.last.samples == 8);
}

TEST_CASE("a paused start waits for a key") {
  FakeSource source(2);
  Stage stage;
  PlayerOptions options;
  options.start_paused = true;
  int asked = 0;
  std::uint64_t sent = 0;
  Player player(
      source, stage.clock, options,
      [&](const ReplaySample&, std::int64_t, const idl::SampleChange&) {
        ++sent;
        return true;
      },
      [&](const PlayerState& state) {
        if (asked++ < 20) {
          CHECK(state.paused);
          CHECK(sent == 0);
          return Key::kNone;
        }
        return asked == 21 ? Key::kPause : Key::kNone;
      });
  CHECK(player.play());
  CHECK(sent == 4);
}

TEST_CASE("passes of a loop follow each other with one interval left out") {
  FakeSource source(3);
  Stage stage;
  PlayerOptions options;
  options.loop = true;
  options.rate = 0.0;
  options.unit = "a";
  stage.most = 9;
  stage.play(source, options);
  std::vector<std::int64_t> intervals;
  for (const Sent& sample : stage.sent) intervals.push_back(sample.interval);
  CHECK(intervals == std::vector<std::int64_t>{0, 1, 2, 4, 5, 6, 8, 9, 10});
  for (std::size_t i = 1; i < stage.sent.size(); ++i)
    CHECK(stage.sent[i].source_time_ns > stage.sent[i - 1].source_time_ns);
  CHECK(stage.last.passes == 3);
}

TEST_CASE("a loop over nothing ends") {
  FakeSource source(3);
  Stage stage;
  PlayerOptions options;
  options.loop = true;
  options.unit = "nobody";
  stage.play(source, options);
  CHECK(stage.sent.empty());
}

TEST_CASE("a selection that chooses nothing is said before anything is played") {
  FakeSource source(10);  // units a and b, 9.5 s
  const auto said = [&](const PlayerOptions& options) -> std::string {
    try {
      check_selection(source, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  PlayerOptions options;
  CHECK(said(options).empty());
  ReplaySample first;
  REQUIRE(source.next(first));
  CHECK(first.log_time_ns == 50 * kSecond);  // nothing was used up
  source.rewind();
  options.unit = "zzz";
  CHECK(said(options) == "--unit: the recording has no unit 'zzz', but a, b");
  options.unit = "b";
  options.remap = {{"b", "c"}, {"x", "y"}};
  CHECK(said(options) == "--remap: the recording has no unit 'x', but a, b");
  options.remap = {{"b", "c"}};
  options.start_offset_ns = 9 * kSecond;
  CHECK(said(options).empty());
  options.start_offset_ns = 10 * kSecond;
  CHECK(said(options) == "--start-offset: the recording ends after 9.5 s");
  options.start_offset_ns = 9 * kSecond;
  options.duration_ns = kSecond / 4;  // b is half a second later
  const std::string nothing =
      "no sample lies in the part that --start-offset, --duration and --playback-until choose";
  CHECK(said(options) == nothing);
  options.duration_ns = 0;
  options.end_offset_ns = 9 * kSecond;
  CHECK(said(options) == nothing);
  options = {};
  options.end_ns = 50 * kSecond;
  CHECK(said(options) == "--playback-until: the recording begins at 1970-01-01T00:00:50Z");
  options.end_ns = 50 * kSecond + 1;
  CHECK(said(options).empty());
}

TEST_CASE("a recording without chunks does not claim to know its length") {
  const test::TemporaryFolder folder;
  mcap::Bytes file;
  mcap::Encoder encode(file);
  encode.bytes(mcap::kMagic);
  encode.record(mcap::Op::kHeader, [&] {
    encode.text("");
    encode.text("");
  });
  encode.record(mcap::Op::kChannel, [&] {
    encode.u16(1);
    encode.u16(0);
    encode.text("mpm/mv");
    encode.text("cdr");
    encode.map({});
  });
  for (std::uint64_t k = 0; k < 3; ++k)
    encode.record(mcap::Op::kMessage, [&] {
      encode.u16(1);
      encode.u32(0);
      encode.u64(k * kSecond);
      encode.u64(k * kSecond);
      encode.bytes(sample_bytes("a", static_cast<std::int64_t>(k), 0));
    });
  encode.record(mcap::Op::kDataEnd, [&] { encode.u32(0); });
  encode.record(mcap::Op::kFooter, [&] {
    encode.u64(0);
    encode.u64(0);
    encode.u32(0);
  });
  encode.bytes(mcap::kMagic);
  test::write_file(folder.file("bare.mcap"),
                   {reinterpret_cast<const char*>(file.data()), file.size()});
  McapSource source({folder.file("bare.mcap")}, {"mpm/mv"});
  CHECK(source.length_ns() == 0);
  ReplaySample sample;
  int count = 0;
  while (source.next(sample)) ++count;
  CHECK(count == 3);
}

TEST_CASE("the pacer stays exact over years and at odd rates") {
  constexpr std::int64_t kYear = 31'557'600 * kSecond;
  const Pacer years(1.0, 0, 0);
  CHECK(std::abs(years.due(20 * kYear) - 20 * kYear) < 100);  // a double has 53 bits
  const Pacer slow(1e-6, 0, 0);
  CHECK(slow.due(kYear) > 0);  // no overflow
  Pacer pacer(2.0, 100, 1000);
  pacer.pause(1010);  // recorded 120
  pacer.resume(5000);
  CHECK(pacer.due(140) == 5010);
  pacer.set_rate(1.0, 5005);  // recorded 130
  CHECK(pacer.due(140) == 5015);
}

}  // namespace mpm::bag::player_test
