#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <regex>
#include <thread>

#include "daemon/history/alarm_store.hpp"
#include "daemon/report/record_json.hpp"
#include "tests/system/bench.hpp"
#include "tests/system/disk_image.hpp"

namespace mpm::test::power_cut_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using history::AlarmEntry;
using history::AlarmStore;

constexpr int kFrames = 3600;
constexpr std::size_t kChannels = 2;
constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

/// The gain of u1 is half as large again as the model's in the second and the fourth quarter.
std::vector<Frame> frames_with_alarms() {
  Plant right(2.0), wrong(3.0);  // the same moves
  std::vector<Frame> frames;
  for (int i = 0; i < kFrames; ++i) {
    const Frame& as_modelled = right.next();
    const Frame& otherwise = wrong.next();
    frames.push_back(i / (kFrames / 4) % 2 == 0 ? as_modelled : otherwise);
  }
  return frames;
}

std::string line_of(const AlarmEntry& entry) {
  return std::to_string(entry.written_ns) + ' ' + entry.mv + ' ' + entry.cv + ' ' + entry.what +
         ' ' + std::string(to_string(entry.standing.word()));
}

std::vector<std::string> entries_of(const std::string& store) {
  std::vector<std::string> lines;
  AlarmStore(store, AlarmStore::Access::kRead).each({}, [&](const AlarmEntry& entry) {
    lines.push_back(line_of(entry));
  });
  return lines;
}

/// A monitor whose state is on a disk that keeps nothing but what it must.
class Machine {
 public:
  explicit Machine(const std::string& test, const std::string& memory = "memory: 200, ")
      : domain_(idl::test_domain(test)), participant_(domain_), readers_(participant_) {
    write_file(file("toy.yaml"),
               unit_yaml("toy") + "monitor: {" + memory + "diagnosis_samples: 0}\n");
    write_file(file("token"), std::string(kToken) + "\n");
    fs::permissions(file("token"), fs::perms::owner_read);
    fs::create_directory(file("state"));
    start();
  }

  void publish(const std::vector<Frame>& frames, std::size_t from, std::size_t until) {
    REQUIRE(publisher_.wait_for_readers(20s));
    for (std::size_t i = from; i < until; ++i) REQUIRE(publisher_.publish(frames[i]));
  }
  /// Acknowledges the controller's alarm, which may not stand.
  void acknowledge() {
    Process mpm({"mpm", "ack", "--unit", "toy", "--domain", std::to_string(domain_.domain),
                 "--partition", domain_.partition, "--comment", "seen"},
                file("out"), file("err"), {"MPM_TOKEN_FILE=" + file("token")});
    REQUIRE(mpm.wait(20s).has_value());
  }
  /// The power goes, and comes back: all that was said to be on the disk must be.
  void cut(Cut cut, std::mt19937_64& random) {
    const std::vector<std::string> promised = entries_of(store());
    daemon_->send(SIGKILL);
    REQUIRE(daemon_->wait(10s));
    daemon_.reset();
    fs::remove_all(file("image"));
    cut_power(file("state"), file("disk"), file("image"), cut, random);
    fs::remove_all(file("state"));
    fs::rename(file("image"), file("state"));

    // Looked at in a copy: who opens the journal mends it.
    fs::remove_all(file("look"));
    fs::copy(file("state"), file("look"));
    check_journal(file("look") + "/alarms.sqlite", promised);
    start();
    REQUIRE(observe([&] {
      return seen<AlarmStateRecord>().size() >= kChannels && !seen<ControllerAlarmRecord>().empty();
    }));
    // Where the power went between the two, the samples on the disk are ahead of the journal; it
    // follows. That nothing is told of an alarm but what came of its samples, `rises_and_falls`
    // says.
    std::string otherwise;
    const bool as_the_journal = observe([&] { return (otherwise = told_otherwise()).empty(); });
    CAPTURE(otherwise, log());
    CHECK(as_the_journal);
  }
  /// Until all has been said of that interval.
  void await(std::int64_t interval) {
    REQUIRE(observe([&] { return verdicts(interval).size() == kChannels; }));
  }
  [[nodiscard]] std::vector<std::string> verdicts(std::int64_t interval) const {
    std::vector<std::string> lines;
    for (const ChannelRecord& record : seen<ChannelRecord>())
      if (record.interval == interval) lines.push_back(report::json_text(report::json_of(record)));
    return lines;
  }
  /// What became of the alarm of u1, without what people did, once it is as expected.
  [[nodiscard]] std::vector<std::string> rises_and_falls(const std::vector<std::string>& expected) {
    std::vector<std::string> words;
    static_cast<void>(idl::eventually([&] {
      words.clear();
      AlarmStore(store(), AlarmStore::Access::kRead)
          .each({.since_ns = {}, .until_ns = {}, .unit = "toy", .mv = "u1", .cv = "y1"},
                [&](const AlarmEntry& entry) {
                  if (entry.what == "active" || entry.what == "cleared")
                    words.push_back(entry.what);
                });
      return words.size() >= expected.size();
    }));
    return words;
  }
  [[nodiscard]] std::size_t entries() const { return entries_of(store()).size(); }
  /// Samples that the one that runs has from before, and how long it took to say so.
  [[nodiscard]] std::size_t taken() const { return taken_; }
  [[nodiscard]] double slowest_start_s() const { return slowest_start_s_; }
  [[nodiscard]] std::string log() const { return read_file(file("mpmd.err")); }

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] std::string store() const { return file("state") + "/alarms.sqlite"; }
  static void check_journal(const std::string& path, const std::vector<std::string>& promised) {
    const AlarmStore left(path, AlarmStore::Access::kRead);
    CHECK(left.verify().problem.empty());
    std::vector<std::string> there = entries_of(path);
    REQUIRE(there.size() >= promised.size());
    there.resize(promised.size());
    CHECK(there == promised);
  }
  /// The journal's last entries that are not how the alarms are told to stand; empty: none.
  [[nodiscard]] std::string told_otherwise() const {
    std::string lines;
    for (const AlarmEntry& entry :
         AlarmStore(store(), AlarmStore::Access::kRead).last_of_each("toy")) {
      const bool active = entry.standing.annunciation == Annunciation::kUnacknowledged ||
                          entry.standing.annunciation == Annunciation::kAcknowledged;
      bool same = true;
      if (entry.cv.empty()) {
        const ControllerAlarmRecord told = seen<ControllerAlarmRecord>().back();
        same = told.view.alarm_state == entry.standing.word() &&
               (told.state == AlarmState::kActive) == active;
      }
      for (const AlarmStateRecord& told : seen<AlarmStateRecord>())
        if (told.mv == entry.mv && told.cv == entry.cv)
          same = told.view.alarm_state == entry.standing.word() &&
                 (told.to == AlarmChange::kActive) == active;
      if (!same) lines += line_of(entry) + '\n';
    }
    return lines;
  }
  template <class Record>
  [[nodiscard]] std::vector<Record> seen() const {
    std::vector<Record> records;
    for (const idl::Output& output : outputs_)
      if (const auto* record = std::get_if<Record>(&output)) records.push_back(*record);
    return records;
  }
  template <class Done>
  [[nodiscard]] bool observe(Done&& done) {
    return idl::eventually(
        [&] {
          for (const idl::Output& output : readers_.take()) outputs_.push_back(output);
          return done();
        },
        20s);
  }

  void start() {
    fs::remove_all(file("disk"));
    for (const char* part : {"disk", "disk/synced", "disk/names", "disk/held"})
      fs::create_directory(file(part));
    static_cast<void>(readers_.take());
    outputs_.clear();
    const char* told = std::getenv("ASAN_OPTIONS");  // it wants to be loaded first
    const auto begin = std::chrono::steady_clock::now();
    daemon_.emplace(
        std::vector<std::string>{"mpmd", "--config", file("toy.yaml"), "--domain",
                                 std::to_string(domain_.domain), "--partition", domain_.partition,
                                 "--state-dir", file("state"), "--token-file", file("token")},
        file("mpmd.out"), file("mpmd.err"),
        std::vector<std::string>{std::string("LD_PRELOAD=") + MPM_POWER_CUT,
                                 "MPM_POWER_FOLDER=" + file("state"),
                                 "MPM_POWER_DISK=" + file("disk"),
                                 std::string("ASAN_OPTIONS=") + (told == nullptr ? "" : told) +
                                     ":verify_asan_link_order=0"});
    std::smatch found;
    std::string text;
    REQUIRE(idl::eventually(
        [&] {
          text = log();
          return std::regex_search(text, found,
                                   std::regex("begins anew|goes on behind ([0-9]+)")) &&
                 text.find("watching") != std::string::npos;
        },
        20s));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    slowest_start_s_ = std::max(slowest_start_s_, took.count());
    taken_ = found[1].matched ? std::stoul(found[1]) : 0;
  }

  TemporaryFolder folder_;
  idl::DomainOptions domain_;
  idl::Participant participant_;
  idl::OutputReaders readers_;
  UnitLayout layout_ = [] {
    UnitLayout layout;
    layout.unit = "toy";
    layout[SignalKind::kMv].tags = {"u1", "u2"};
    layout[SignalKind::kCv].tags = {"y1"};
    return layout;
  }();
  idl::UnitPublisher publisher_{participant_, layout_, idl::WriterPace::kLossless};
  std::vector<idl::Output> outputs_;
  std::optional<Process> daemon_;
  std::size_t taken_ = 0;
  double slowest_start_s_ = 0.0;
};

const std::vector<std::string> kAlarms = {"active", "cleared", "active"};

struct Outcome {
  std::vector<std::string> verdicts, rises_and_falls;
};

/// All frames, with the power cut now and then; where only what was synced is left they go on from
/// the first one that the disk no longer has, as a recording would bring it. Of a torn disk's they
/// go on from where they were: what has gone is lost, and with it any alarm but that of the last
/// quarter, which comes whole behind the last cut.
Outcome run_over_cuts(const std::string& test, int cuts, Cut kind, std::uint64_t seed) {
  Machine machine(test);
  const std::vector<Frame> frames = frames_with_alarms();
  std::mt19937_64 random(seed);
  std::size_t at = 0;
  const std::size_t last = kind == Cut::kTorn ? frames.size() * 3 / 4 : frames.size() - 100;
  for (int left = cuts; left > 0; --left) {
    const std::size_t step = 1 + random() % (2 * last / static_cast<std::size_t>(cuts));
    const std::size_t until = std::min(at + step, last);
    machine.publish(frames, at, until);
    if (random() % 3 == 0) machine.acknowledge();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 40'000));
    CAPTURE(left, until);
    machine.cut(kind, random);
    if (kind == Cut::kNothingMore) REQUIRE(machine.taken() <= until);
    at =
        kind == Cut::kNothingMore ? machine.taken() : until;  // torn, it has some of the later ones
  }
  machine.publish(frames, at, frames.size());
  machine.await(frames.back().interval);
  UNSCOPED_INFO(machine.log());
  UNSCOPED_INFO(test << ": " << cuts << " power cuts, slowest start " << machine.slowest_start_s()
                     << " s");
  return {machine.verdicts(frames.back().interval), machine.rises_and_falls(kAlarms)};
}

// What a machine says whose power never went is what one says that lost all that it was not sure
// of, once the samples that went are there again.
TEST_CASE("a power cut takes no alarm, and no more samples than were not on the disk") {
  const Outcome whole = run_over_cuts("power-whole", 0, Cut::kNothingMore, 1);
  CHECK(whole.rises_and_falls == kAlarms);
  const Outcome cut = run_over_cuts("power-cut", 8, Cut::kNothingMore, 1);
  CHECK(cut.verdicts == whole.verdicts);
  CHECK(cut.rises_and_falls == kAlarms);
}

// The journal of alarms, which is synced, is not to be ahead of the samples, which are not: they
// would have it cleared, and raised again.
TEST_CASE("an alarm that has just risen stands after a power cut") {
  Machine machine("power-risen", "");  // with a long memory: its state is written seldom
  const std::vector<Frame> frames = frames_with_alarms();
  std::mt19937_64 random(3);
  std::size_t at = kFrames / 4;
  machine.publish(frames, 0, at);
  const std::vector<std::string> risen = {"active"};
  for (; at < kFrames / 2; at += 10) {
    machine.publish(frames, at, at + 10);
    machine.await(frames[at + 9].interval);
    if (machine.entries() > 0) break;
  }
  machine.cut(Cut::kNothingMore, random);
  const std::size_t again = machine.taken();
  machine.publish(frames, again, again + 50);
  machine.await(frames[again + 49].interval);
  CHECK(machine.rises_and_falls({"active", "none"}) == risen);
}

/// As an alarm does: it rises, clears, rises ..., and stands in the end.
bool alternates(const std::vector<std::string>& words) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] != (i % 2 == 0 ? "active" : "cleared")) return false;
  return words.size() % 2 == 1;
}

// Pages, lengths and names that were not synced are there or not, as it comes. What was lost may be
// all of an alarm's time; what is left must be whole.
TEST_CASE("what a power cut tears is left out") {
  const Outcome torn = run_over_cuts("power-torn", 8, Cut::kTorn, 2);
  CAPTURE(torn.rises_and_falls);
  CHECK(alternates(torn.rises_and_falls));
}

TEST_CASE("a hundred power cuts take no alarm", "[.long]") {
  const Outcome whole = run_over_cuts("power-whole-long", 0, Cut::kNothingMore, 1);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Outcome cut = run_over_cuts("power-cut-long", 10, Cut::kNothingMore, 100 + seed);
    CHECK(cut.verdicts == whole.verdicts);
    CHECK(cut.rises_and_falls == kAlarms);
    CHECK(alternates(run_over_cuts("power-torn-long", 10, Cut::kTorn, 200 + seed).rises_and_falls));
  }
}

}  // namespace
}  // namespace mpm::test::power_cut_test
