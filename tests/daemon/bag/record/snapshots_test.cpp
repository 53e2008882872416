#include "daemon/bag/record/snapshots.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <set>
#include <stdexcept>

#include "daemon/bag/record/recording_writer.hpp"
#include "daemon/mcap/read/file_sequence.hpp"
#include "idl/cdr.hpp"
#include "tests/system/process.hpp"

namespace mpm::bag::snapshots_test {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kSecond = 1'000'000'000, kMinute = 60 * kSecond;
constexpr std::int64_t kStart = 1'700'000'000 * kSecond;  // 2023-11-14T22:13:20Z

std::vector<std::byte> event_bytes(std::string unit, std::string mv, std::string cv, std::string to,
                                   std::int64_t source_time_ns) {
  std::string none;
  mpm_AlarmEvent event{};
  event.unit = unit.data();
  event.mv = mv.data();
  event.cv = cv.data();
  event.to = to.data();
  event.source_time_ns = source_time_ns;
  event.cause = event.cause_text = none.data();
  idl::CdrEncoder<mpm_AlarmEvent> encoder;
  const auto cdr = encoder.encode(event);
  return {cdr.begin(), cdr.end()};
}

/// A recorder in virtual time: one sample a second, alarms when told.
class Run {
 public:
  explicit Run(const test::TemporaryFolder& folder, const SnapshotOptions& snapshots,
               std::int64_t start_ns = kStart)
      : now_ns(start_ns), writer_(options_of(folder, snapshots), start_ns) {
    sample_ = writer_.add_topic({"mpm/mv", "mpm::Sample", "text", 0, true});
    event_ = writer_.add_topic({"mpm/alarm_event", "mpm::AlarmEvent", "text", 0, false});
  }

  void go(std::int64_t seconds) {
    for (std::int64_t i = 0; i < seconds; ++i) {
      now_ns += kSecond;
      std::string unit = "shell";
      mpm_Sample sample{};
      sample.unit = unit.data();
      sample.interval = now_ns / kSecond;
      idl::CdrEncoder<mpm_Sample> encoder;
      write(sample_, encoder.encode(sample), now_ns);
      writer_.tick(now_ns);
    }
  }
  /// Told by the monitor at `told_ns`.
  void alarm(const std::string& mv, std::int64_t told_ns, const std::string& to = "active") {
    write(event_, event_bytes("shell", mv, "y1", to, told_ns), told_ns);
  }
  /// Told now, by a machine whose clock is `ahead_ns` before ours; ours is as well.
  void alarm_by_another_clock(const std::string& mv, std::int64_t ahead_ns) {
    const std::int64_t told_ns = now_ns + ahead_ns;
    write(event_, event_bytes("shell", mv, "y1", "active", told_ns), told_ns, 0);
  }
  void by_hand() { writer_.save(now_ns); }
  void finish() { writer_.finish(); }
  [[nodiscard]] std::vector<std::string> news() { return writer_.take_news(); }

  std::int64_t now_ns;

 private:
  static RecordingOptions options_of(const test::TemporaryFolder& folder,
                                     const SnapshotOptions& snapshots) {
    RecordingOptions options;
    options.output = folder.file("ring");
    options.snapshots = snapshots;
    return options;
  }
  void write(std::size_t topic, std::span<const std::byte> cdr, std::int64_t source_time_ns) {
    write(topic, cdr, source_time_ns, now_ns - source_time_ns);
  }
  void write(std::size_t topic, std::span<const std::byte> cdr, std::int64_t source_time_ns,
             std::int64_t age_ns) {
    RecordedSample sample{topic, now_ns, {}, age_ns};
    sample.sample.cdr.assign(cdr.begin(), cdr.end());
    sample.sample.source_time_ns = source_time_ns;
    writer_.write(sample);
  }

  RecordingWriter writer_;
  std::size_t sample_ = 0, event_ = 0;
};

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

/// Seconds since kStart of the samples in a folder.
std::vector<std::int64_t> seconds_in(const std::string& folder) {
  std::vector<std::int64_t> seconds;
  mcap::FileSequence messages({folder});
  mcap::Message message;
  while (messages.next(message))
    if (message.channel->topic == "mpm/mv")
      seconds.push_back((message.log_time_ns - kStart) / kSecond);
  return seconds;
}

bool consecutive(const std::vector<std::int64_t>& numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(),
                            [](auto a, auto b) { return b != a + 1; }) == numbers.end();
}

constexpr SnapshotOptions kHour = {.before_ns = 60 * kMinute, .after_ns = 10 * kMinute};

}  // namespace

TEST_CASE("a snapshot is named by what alarmed and when, whatever that is called") {
  constexpr std::int64_t kNoon = 1'714'564'800 * kSecond;  // 2024-05-01T12:00:00Z
  CHECK(alarm_snapshot(event_bytes("shell", "u1", "y1", "active", kNoon)) ==
        "shell-u1-y1-20240501T120000Z");
  CHECK(alarm_snapshot(event_bytes("../x", "a/b", "y 1", "active", kNoon)) ==
        "%2E.%2Fx-a%2Fb-y%201-20240501T120000Z");
  const std::string longest(128, '/');
  CHECK(alarm_snapshot(event_bytes(longest, longest, longest, "active", kNoon)).value().size() <
        255);
  CHECK_FALSE(alarm_snapshot(event_bytes("shell", "u1", "y1", "cleared", kNoon)));
  CHECK_FALSE(alarm_snapshot(event_bytes("shell", "u1", "y1", "diagnosed", kNoon)));
  CHECK_FALSE(alarm_snapshot({}));
  CHECK(hand_snapshot(kNoon) == "by-hand-20240501T120000Z");
}

TEST_CASE("an alarm saves what came before and after it, and nothing deletes that") {
  const test::TemporaryFolder folder;
  Run run(folder, kHour);
  run.go(3 * 3600);
  run.alarm("u1", run.now_ns);
  run.go(2 * 3600);
  run.alarm("u1", run.now_ns, "cleared");
  run.finish();
  // The ring has the last hour and the file in which it begins, of an eighth of an hour.
  const std::vector<std::int64_t> ring = seconds_in(folder.file("ring"));
  CHECK(ring.back() == 5 * 3600);
  CHECK(ring.front() <= 4 * 3600);
  CHECK(ring.front() >= 4 * 3600 - 2 * 450);
  CHECK(consecutive(ring));
  const std::string name = "shell-u1-y1-20231115T011320Z";  // three hours after the start
  CHECK(names_in(folder.file("ring/saved")) == std::set<std::string>{name});
  const std::vector<std::int64_t> saved = seconds_in(folder.file("ring/saved/" + name));
  CHECK(consecutive(saved));
  CHECK(saved.front() <= 2 * 3600);
  CHECK(saved.front() >= 2 * 3600 - 2 * 450);
  CHECK(saved.back() >= 3 * 3600 + 600 - 1);
  CHECK(saved.back() <= 3 * 3600 + 601);
  const std::vector<std::string> news = run.news();
  REQUIRE(news.size() == 2);
  CHECK(news[0] == "saving " + folder.file("ring/saved/" + name) + " until 2023-11-15T01:23:20Z");
  CHECK(news[1].starts_with("saved " + folder.file("ring/saved/" + name) + ": "));
}

TEST_CASE("snapshots that overlap share their files") {
  const test::TemporaryFolder folder;
  Run run(folder, kHour);
  run.go(3600);
  run.alarm("u1", run.now_ns);
  run.alarm("u1", run.now_ns);  // said twice, by two monitors
  run.go(300);
  run.alarm("u2", run.now_ns);
  run.go(3600);
  run.finish();
  const std::string one = folder.file("ring/saved/shell-u1-y1-20231114T231320Z");
  const std::string two = folder.file("ring/saved/shell-u2-y1-20231114T231820Z");
  CHECK(names_in(folder.file("ring/saved")).size() == 2);
  std::size_t shared = 0;
  for (const std::string& name : names_in(one))
    if (fs::exists(fs::path(two) / name) &&
        fs::equivalent(fs::path(one) / name, fs::path(two) / name))
      ++shared;
  CHECK(shared > 6);
  CHECK(seconds_in(one).back() == 3600 + 600 - 1);
  CHECK(seconds_in(two).back() == 3900 + 600 - 1);
}

TEST_CASE("a snapshot by hand is there at once") {
  const test::TemporaryFolder folder;
  Run run(folder, kHour);
  run.go(100);
  run.by_hand();
  const std::vector<std::int64_t> saved =
      seconds_in(folder.file("ring/saved/by-hand-20231114T221500Z"));
  CHECK(saved.size() == 100);
  CHECK(consecutive(saved));
  run.go(10);
  run.finish();
  CHECK(seconds_in(folder.file("ring")).size() == 110);
}

TEST_CASE("what a monitor said long ago makes no snapshot") {
  const test::TemporaryFolder folder;
  Run run(folder, kHour);
  run.go(10);
  run.alarm("u1", run.now_ns - 11 * kMinute);
  run.go(1000);
  run.finish();
  CHECK(names_in(folder.file("ring/saved")).empty());
  CHECK(run.news().empty());
}

TEST_CASE("a clock that was set since the recording began makes no snapshot late or lost") {
  const test::TemporaryFolder folder;
  Run run(folder, kHour);
  run.go(3600);
  run.alarm_by_another_clock("u1", -24 * 60 * kMinute);
  run.go(900);
  run.finish();
  const std::vector<std::int64_t> saved =
      seconds_in(folder.file("ring/saved/shell-u1-y1-20231113T231320Z"));
  CHECK(saved.front() == 1);
  CHECK(saved.back() == 3600 + 600 - 1);
}

TEST_CASE("a recorder that was killed leaves whole files, and the next one goes on") {
  const test::TemporaryFolder folder;
  const std::string saved = folder.file("ring/saved/shell-u1-y1-20231114T231320Z");
  constexpr std::int64_t kAlarm = kStart + 3600 * kSecond;
  {
    Run killed(folder, kHour);
    killed.go(3600);
    killed.alarm("u1", kAlarm);
    killed.go(60);  // its last chunk of a second is lost, and its file has no end
  }
  for (const std::string& name : names_in(saved))
    CHECK_NOTHROW(mcap::FileSequence({saved + "/" + name}));
  CHECK(consecutive(seconds_in(saved)));
  const std::size_t before = names_in(saved).size();
  CHECK(before == 8);

  Run next(folder, kHour, kAlarm + 100 * kSecond);
  next.alarm("u1", kAlarm);  // mpm/alarm_event tells late joiners
  next.go(3600);
  next.finish();
  const std::vector<std::int64_t> all = seconds_in(saved);
  CHECK(all.back() == 4200 - 1);
  CHECK(std::count(all.begin(), all.end(), 3650) == 1);  // mended: between alarm and kill
  CHECK(names_in(saved).size() > before);
  CHECK(names_in(folder.file("ring/saved")).size() == 1);
}

TEST_CASE("saved ones are bounded, and none goes silently") {
  const test::TemporaryFolder folder;
  SnapshotOptions options = kHour;
  options.quota_bytes = 1;
  fs::create_directories(folder.file("ring/saved/notes"));
  const auto begin_two = [&](std::int64_t start_ns) {
    Run run(folder, options, start_ns);
    run.go(3600);
    run.alarm("u1", run.now_ns);
    run.go(1800);
    run.alarm("u2", run.now_ns);
    run.go(1800);
    run.finish();
    return run.news();
  };
  const std::string one = "shell-u1-y1-20231114T231320Z", two = "shell-u2-y1-20231114T234320Z";
  const std::vector<std::string> news = begin_two(kStart);
  REQUIRE(news.size() == 3);
  CHECK(news[2] == two + " is not saved: what lies in " + folder.file("ring/saved") +
                       " takes all that it may");
  CHECK(names_in(folder.file("ring/saved")) == std::set<std::string>{one, "notes"});

  options.drop_oldest = true;
  const std::vector<std::string> dropping = begin_two(kStart + 7200 * kSecond);
  REQUIRE(dropping.size() == 6);
  CHECK(dropping[0].starts_with("deleting " + folder.file("ring/saved/" + one)));
  CHECK(names_in(folder.file("ring/saved")) ==
        std::set<std::string>{"notes", "shell-u2-y1-20231115T014320Z"});
}

TEST_CASE("a place where files have no second names is refused at once") {
  const test::TemporaryFolder folder;
  fs::create_directories(folder.file("ring"));
  test::write_file(folder.file("ring/saved"), "in the way");
  CHECK_THROWS_AS(Run(folder, kHour), std::invalid_argument);
}

}  // namespace mpm::bag::snapshots_test
