#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <thread>

#include "config/load_unit.hpp"
#include "daemon/history/alarm_store.hpp"
#include "daemon/live/monitor_service.hpp"
#include "daemon/live/sample_log.hpp"
#include "daemon/live/unit_samples.hpp"
#include "daemon/report/record_json.hpp"
#include "tests/daemon/http/connection.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test::restart_test {
namespace {

constexpr int kFrames = 4000;
constexpr std::size_t kChannels = 2;

std::vector<Frame> frames_of(Plant& plant, int count) {
  std::vector<Frame> frames;
  frames.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) frames.push_back(plant.next());
  return frames;
}

/// A unit, and a monitor that keeps its state, which may be killed and comes back.
struct Corner {
  /// `more`: lines of the unit file.
  /// `options`: more arguments of those that come back.
  explicit Corner(const std::string& test, const std::string& more = "",
                  std::vector<std::string> options = {})
      : bench(test, {"--state-dir", folder.file("state")}),
        publisher(bench.publisher(idl::WriterPace::kLossless)),
        more_options(std::move(options)) {
    if (more.empty()) return;
    const std::string file = bench.folder.file("toy.yaml");
    write_file(file, read_file(file) + more);
    kill_and_start();
  }

  void publish(const std::vector<Frame>& frames) {
    REQUIRE(publisher.wait_for_readers(std::chrono::seconds(20)));
    for (const Frame& frame : frames) REQUIRE(publisher.publish(frame));
  }
  /// Until all has been said of that interval.
  void await(std::int64_t interval) {
    REQUIRE(bench.observe([&] { return verdicts(interval).size() == kChannels; }));
  }
  /// The next frames, until all has been said of the last of them, whose interval it returns.
  std::int64_t play(Plant& plant, int count) {
    const std::vector<Frame> frames = frames_of(plant, count);
    publish(frames);
    await(frames.back().interval);
    return frames.back().interval;
  }
  /// Kills whatever runs, and starts the next one; how many samples that one has from before.
  std::size_t kill_and_start() {
    kill();
    return start();
  }
  void kill() {
    Process& running = again ? *again : bench.daemon;
    running.send(SIGKILL);
    REQUIRE(running.wait(std::chrono::seconds(10)));
    again.reset();
  }
  std::size_t start() {
    std::vector<std::string> command{"mpmd",
                                     "--config",
                                     bench.folder.file("toy.yaml"),
                                     "--domain",
                                     std::to_string(bench.options.domain),
                                     "--partition",
                                     bench.options.partition,
                                     "--state-dir",
                                     folder.file("state")};
    command.insert(command.end(), more_options.begin(), more_options.end());
    again.emplace(command, folder.file("out"), folder.file("err"));
    std::smatch taken;
    std::string log;
    REQUIRE(idl::eventually(
        [&] {
          log = read_file(folder.file("err"));
          return std::regex_search(log, taken,
                                   std::regex("begins anew|goes on behind ([0-9]+) sample"));
        },
        std::chrono::seconds(20)));
    return taken[1].matched ? std::stoul(taken[1]) : 0;
  }
  /// The verdict on each channel at `interval`, and the alarms that were raised and cleared.
  [[nodiscard]] std::vector<std::string> verdicts(std::int64_t interval) const {
    std::vector<std::string> lines;
    for (const ChannelRecord& record : bench.seen<ChannelRecord>())
      if (record.interval == interval) lines.push_back(report::json_text(report::json_of(record)));
    return lines;
  }
  [[nodiscard]] std::vector<std::string> alarms() const {
    std::vector<std::string> lines;
    for (const AlarmRecord& record : bench.seen<AlarmRecord>())
      if (record.to != AlarmChange::kDiagnosed)
        lines.push_back(report::json_text(report::json_of(record)));
    return lines;
  }
  [[nodiscard]] AlarmStateRecord standing(const std::string& mv) const {
    AlarmStateRecord last;
    for (const AlarmStateRecord& alarm : bench.seen<AlarmStateRecord>())
      if (alarm.mv == mv) last = alarm;
    return last;
  }

  TemporaryFolder folder;
  Bench bench;
  idl::UnitPublisher publisher;
  std::vector<std::string> more_options;
  std::optional<Process> again;
};

// The expected numbers are those of a monitor that nobody killed. What the killed one had not yet
// taken is sent once more, as its recording would be. At most `most` frames between two kills.
// Returns the log of the last one.
std::string go_on_over_kills(const std::string& name, unsigned most, int least_kills,
                             const std::string& more = "") {
  Corner whole(name + "-whole", more), killed(name + "-killed", more);
  Plant plant(3.0);
  const std::vector<Frame> frames = frames_of(plant, kFrames);
  whole.publish(frames);
  whole.await(frames.back().interval);

  std::mt19937 random(19);
  int kills = 0;
  for (std::size_t at = 0; at < frames.size();) {
    std::size_t end = std::min(at + 1 + random() % most, frames.size());
    const std::vector<Frame> chunk(frames.begin() + static_cast<std::ptrdiff_t>(at),
                                   frames.begin() + static_cast<std::ptrdiff_t>(end));
    killed.publish(chunk);
    if (end < frames.size()) {
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 20'000));
      end = killed.kill_and_start();
      ++kills;
      REQUIRE(end >= at);  // all that was taken before is still there
    }
    at = end;
  }
  killed.await(frames.back().interval);
  std::string log = read_file(killed.folder.file("err"));
  CAPTURE(kills, log);
  CHECK(kills >= least_kills);
  CHECK(killed.verdicts(frames.back().interval) == whole.verdicts(frames.back().interval));
  CHECK(whole.alarms().size() == 1);
  CHECK(killed.standing("u1").to == AlarmChange::kActive);
  CHECK(killed.standing("u1").interval == whole.standing("u1").interval);
  CHECK(killed.standing("u1").view.alarm_state == AlarmWord::kUnacknowledged);
  return log;
}

TEST_CASE("a monitor that is killed at any moment goes on as if it had not been") {
  (void)go_on_over_kills("restart", 2000, 2);
}

// With so short a memory a few hundred samples are kept, of which the state of a monitor that began
// at the first one cannot be had again: it must have been kept itself.
TEST_CASE("a monitor that is killed goes on from its state when the samples behind it have gone") {
  const std::string log =
      go_on_over_kills("restart-state", 1500, 3, "monitor: {memory: 200, diagnosis_samples: 0}\n");
  std::smatch found;
  REQUIRE(std::regex_search(
      log, found,
      std::regex("goes on behind ([0-9]+) samples from before, of which it judges ([0-9]+)")));
  CHECK(std::stoi(found[2]) < std::stoi(found[1]));
}

TEST_CASE("a state that is damaged is replaced by the one before, or by the samples kept") {
  Corner corner("restart-damaged", "monitor: {memory: 200, diagnosis_samples: 0}\n");
  Plant plant(3.0);
  for (int i = 0; i < 4; ++i) corner.play(plant, 1000);
  const std::string samples = corner.folder.file("state") + "/samples/toy";
  // While nobody writes. One more than is kept, where the kill came before the first had gone.
  corner.kill();
  std::vector<std::filesystem::path> states;
  for (const auto& entry : std::filesystem::directory_iterator(samples))
    if (entry.path().filename().string().starts_with("state-")) states.push_back(entry.path());
  REQUIRE(states.size() >= 2);
  REQUIRE(states.size() <= 3);
  const auto number = [](const std::filesystem::path& path) {
    return std::stoi(path.filename().string().substr(6));
  };
  const std::string newest =
      std::max_element(states.begin(), states.end(), [&](const auto& a, const auto& b) {
        return number(a) < number(b);
      })->string();
  std::string bytes = read_file(newest);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_file(newest, bytes);
  CHECK(corner.start() == 4000);
  corner.play(plant, 5);
  REQUIRE(corner.bench.observe([&] { return corner.standing("u1").to == AlarmChange::kActive; }));

  corner.kill();
  for (const auto& entry : std::filesystem::directory_iterator(samples))
    if (entry.path().filename().string().starts_with("state-"))
      std::filesystem::remove(entry.path());
  const std::size_t kept = corner.start();
  CHECK(kept > 500);
  CHECK(kept < 2000);
}

TEST_CASE("what of the state cannot be read is named, and the monitor goes on without it") {
  namespace fs = std::filesystem;
  Corner corner("restart-unreadable", "monitor: {memory: 200, diagnosis_samples: 0}\n");
  Plant plant(3.0);
  for (int i = 0; i < 3; ++i) corner.play(plant, 1000);
  const std::string samples = corner.folder.file("state") + "/samples";
  const auto make_folder_of_last = [&](const std::string& prefix) {
    std::string last;
    for (const auto& entry : fs::directory_iterator(samples + "/toy"))
      if (entry.path().filename().string().starts_with(prefix))
        last = std::max(last, entry.path().string());
    fs::remove(last);
    fs::create_directory(last);
    return last;
  };
  const auto warned = [&](const std::string& text) {
    const std::string log = read_file(corner.folder.file("err"));
    CAPTURE(log);
    CHECK(log.find("warning toy: " + text) != std::string::npos);
  };
  corner.kill();
  const std::string state = make_folder_of_last("state-");
  const std::string kept = make_folder_of_last("samples-");
  CHECK(corner.start() > 0);
  warned(state + " is not used: it cannot be read: Is a directory");
  warned("not all samples that were kept are used: " + kept + " cannot be read: Is a directory");
  corner.play(plant, 5);

  corner.kill();
  fs::remove_all(samples);
  write_file(samples, "");
  CHECK(corner.start() == 0);
  warned("not all samples that were kept are used: " + samples +
         "/toy cannot be read: Not a directory");
  corner.play(plant, 5);
}

TEST_CASE("a monitor that is to end does not first judge all samples from before") {
  const TemporaryFolder folder;
  write_file(folder.file("toy.yaml"), unit_yaml("toy"));
  config::UnitConfig unit = config::load_unit(folder.file("toy.yaml")).config;
  unit.dds.partition = idl::test_domain("restart-stopped").partition;
  live::ServiceOptions options;
  options.samples = folder.file("samples");
  {
    const live::UnitSamples samples = live::samples_of(unit, 1, options.samples);
    live::SampleLog log(samples.folder, samples.meaning, samples.keep);
    const std::vector<double> values = {0.0, 0.0};
    for (int k = 0; k < 100; ++k) (void)log.push({SignalKind::kMv, k, k, values, {}});
  }
  live::DiagnosisWorker worker([](const live::DiagnosisJob&, const live::DiagnosisWorker::GoOn&) {
    return std::optional<live::DiagnosisOutcome>();
  });
  int asked = 0;
  options.stop = [&] { return ++asked == 10; };
  CHECK_THROWS_AS(live::MonitorService({unit}, options, worker), live::RecallStopped);
  CHECK(asked == 10);
}

// Some twelve minutes: a reader that was killed is waited for until its lease has run out.
TEST_CASE("a monitor that is killed a hundred times goes on as if it had not been", "[.long]") {
  (void)go_on_over_kills("restart-hundred", 78, 100,
                         "monitor: {memory: 200, diagnosis_samples: 0}\n");
}

TEST_CASE("an alarm that stands over a restart is neither cleared nor raised anew") {
  Corner corner("restart-alarm");
  Plant plant(3.0);
  corner.play(plant, kFrames);
  REQUIRE(corner.bench.observe([&] { return corner.standing("u1").to == AlarmChange::kActive; }));
  const AlarmStateRecord before = corner.standing("u1");
  const std::size_t raised = corner.alarms().size();
  corner.bench.outputs.clear();
  corner.kill_and_start();
  REQUIRE(corner.bench.observe([&] { return !corner.standing("u1").unit.empty(); }));
  corner.play(plant, 5);
  for (const AlarmStateRecord& alarm : corner.bench.seen<AlarmStateRecord>()) {
    if (alarm.mv != "u1") continue;
    CHECK(alarm.to == AlarmChange::kActive);
    CHECK(alarm.interval == before.interval);
    CHECK(alarm.view.alarm_state == before.view.alarm_state);
  }
  for (const ControllerAlarmRecord& alarm : corner.bench.seen<ControllerAlarmRecord>())
    CHECK(alarm.state == AlarmState::kActive);
  CHECK(raised == 1);
  CHECK(corner.alarms().empty());
}

TEST_CASE(
    "what a monitor missed while it was away is told, and that its data do not come is worse") {
  Corner corner("restart-away");
  Plant plant(3.0);
  corner.play(plant, 300);
  corner.kill();
  for (int i = 0; i < 40; ++i) (void)plant.next();
  corner.bench.outputs.clear();
  corner.start();
  corner.play(plant, 20);
  const auto told = [&](const std::string& words) {
    return corner.bench.observe(
        [&] { return corner.bench.health().detail.find(words) != std::string::npos; });
  };
  CHECK(told("this monitor was away from "));
  CHECK(told(": 40 intervals are missing"));
  corner.kill_and_start();
  CHECK(told("no data for "));
  CHECK(corner.bench.health().state == "failure");
}

TEST_CASE("a journal of alarms that is lost or damaged silences no alarm over a restart") {
  const bool damaged = GENERATE(false, true);
  Corner corner("restart-journal");
  Plant plant(3.0);
  corner.play(plant, kFrames);
  REQUIRE(corner.bench.observe([&] { return corner.standing("u1").to == AlarmChange::kActive; }));
  const AlarmStateRecord before = corner.standing("u1");
  const auto journal = [&](const std::string& end) {
    return corner.folder.file("state") + "/alarms.sqlite" + end;
  };
  corner.kill();
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(journal(end));
  if (damaged) write_file(journal(""), std::string(5000, 'x'));
  corner.bench.outputs.clear();
  corner.start();
  // Before any sample comes.
  REQUIRE(corner.bench.observe([&] {
    return !corner.standing("u1").unit.empty() &&
           !corner.bench.seen<ControllerAlarmRecord>().empty();
  }));
  CHECK(corner.standing("u1").view.alarm_state == AlarmWord::kUnacknowledged);
  CHECK(corner.standing("u1").view.active_time_ns == before.source_time_ns);
  CHECK(corner.bench.seen<ControllerAlarmRecord>().back().state == AlarmState::kActive);
  corner.play(plant, 5);
  CHECK(corner.alarms().empty());
  const std::string log = read_file(corner.folder.file("err"));
  CHECK(log.find("of 1 alarm that stands the journal says nothing") != std::string::npos);
  CHECK((log.find("the journal of alarms is damaged") != std::string::npos) == damaged);
  CHECK(read_file(journal("")).find("SQLite format 3") == 0);
}

// Samples are on the disk before what the journal says of them: killed in between, the journal is
// as it was before the alarm cleared.
TEST_CASE("an alarm whose end the journal had no time to keep is cleared over a restart") {
  namespace fs = std::filesystem;
  Corner corner("restart-unwritten");
  Plant wrong(3.0), right(2.0);  // the same moves
  corner.play(wrong, kFrames);
  for (int i = 0; i < kFrames; ++i) (void)right.next();
  REQUIRE(corner.bench.observe([&] { return corner.standing("u1").to == AlarmChange::kActive; }));
  corner.kill();
  const fs::path state = corner.folder.file("state"), kept = corner.folder.file("kept");
  const auto copy_journal = [](const fs::path& from, const fs::path& to) {
    for (const char* name : {"alarms.sqlite", "alarms.sqlite-wal", "alarms.sqlite-shm"}) {
      fs::remove(to / name);
      if (fs::exists(from / name)) fs::copy(from / name, to / name);
    }
  };
  fs::create_directory(kept);
  copy_journal(state, kept);
  corner.start();
  corner.play(right, kFrames);
  REQUIRE(corner.bench.observe([&] { return corner.standing("u1").to == AlarmChange::kCleared; }));
  corner.kill();
  copy_journal(kept, state);
  corner.bench.outputs.clear();
  corner.start();
  // Before any sample comes.
  REQUIRE(corner.bench.observe([&] {
    return !corner.standing("u1").unit.empty() &&
           !corner.bench.seen<ControllerAlarmRecord>().empty();
  }));
  CHECK(corner.standing("u1").to == AlarmChange::kCleared);
  CHECK(corner.standing("u1").view.alarm_state == AlarmWord::kReturned);
  const history::AlarmStore journal((state / "alarms.sqlite").string(),
                                    history::AlarmStore::Access::kRead);
  REQUIRE(idl::eventually([&] {
    for (const history::AlarmEntry& entry : journal.last_of_each("toy"))
      if (entry.mv == "u1") return entry.what == "cleared";
    return false;
  }));
}

// Both what is judged again and what a state stands for.
TEST_CASE("the page shows what a monitor before it took") {
  Corner corner("restart-page", "", {"--http", "0"});
  Plant plant(3.0);
  const std::vector<Frame> frames = frames_of(plant, kFrames);
  const auto seconds = [](const Frame& frame) {
    return static_cast<double>(frame.source_time_ns) / 1e9;
  };
  const double first_s = seconds(frames.front()), last_s = seconds(frames.back());
  corner.publish(frames);
  corner.await(frames.back().interval);
  REQUIRE(corner.kill_and_start() == kFrames);
  const std::string log = read_file(corner.folder.file("err"));
  std::smatch found;
  REQUIRE(std::regex_search(log, found, std::regex("http://127.0.0.1:([0-9]+)")));
  nlohmann::json series;
  REQUIRE(idl::eventually(
      [&] {
        const Connection connection(std::stoi(found[1]));
        connection.say(
            "GET /api/v1/units/toy/cvs/y1/series?span=1e6 HTTP/1.1\r\nHost: 127.0.0.1\r\n"
            "Connection: close\r\n\r\n");
        const std::string answer = connection.hear();
        const std::size_t body = answer.find("\r\n\r\n");
        if (!answer.starts_with("HTTP/1.1 200") || body == std::string::npos) return false;
        series = nlohmann::json::parse(answer.substr(body));
        return series["last"] == last_s;
      },
      std::chrono::seconds(20)));
  CHECK(series["first"] == first_s);
  CHECK(series["measured"]["mean"].front().is_number());
  // Of those judged again; the last ones are not judged yet.
  const nlohmann::json& residuals = series["residual"]["mean"];
  CHECK(std::any_of(residuals.begin(), residuals.end(),
                    [](const nlohmann::json& value) { return value.is_number(); }));
}

// What 4005 samples told is not to be had again from five.
TEST_CASE("unit files are read anew on SIGHUP, and nothing is forgotten") {
  Corner corner("restart-reload");
  Plant plant(3.0);
  corner.play(plant, kFrames);
  const std::string file = corner.bench.folder.file("toy.yaml"), text = read_file(file);
  const auto log = [&] { return read_file(corner.bench.folder.file("mpmd.err")); };

  write_file(file, text + "monitor: {memory: -1}\n");
  corner.bench.daemon.send(SIGHUP);
  REQUIRE(corner.bench.observe(
      [&] { return log().find("the units go on as they were") != std::string::npos; }));
  CHECK(log().find("toy.yaml:") != std::string::npos);
  corner.play(plant, 5);

  // The gain that the plant has.
  std::string repaired = text;
  const std::size_t at = repaired.find("gain: 2");
  REQUIRE(at != std::string::npos);
  repaired.replace(at, 7, "gain: 3");
  write_file(file, repaired);
  corner.bench.outputs.clear();
  corner.bench.daemon.send(SIGHUP);
  REQUIRE(corner.bench.observe([&] {
    return log().find("goes on behind 4005 samples") != std::string::npos &&
           !corner.standing("u1").unit.empty();
  }));
  corner.bench.outputs.clear();
  const std::int64_t last = corner.play(plant, 5);
  for (const ChannelRecord& record : corner.bench.seen<ChannelRecord>())
    if (record.interval == last) CHECK(record.verdict == Verdict::kMatch);
}

}  // namespace
}  // namespace mpm::test::restart_test
