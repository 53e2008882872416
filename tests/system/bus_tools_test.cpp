#include <fcntl.h>
#include <pty.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <utility>

#include "daemon/mcap/read/ordered_reader.hpp"
#include "idl/raw_sample.hpp"
#include "idl/sample_readers.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

constexpr std::chrono::seconds kPatience{20};

/// mpm on a corner of the network of its own, and a toy unit there.
struct Corner {
  explicit Corner(const std::string& test) : domain(idl::test_domain(test)), participant(domain) {
    write_file(folder.file("toy.yaml"), unit_yaml("toy"));
  }
  [[nodiscard]] std::vector<std::string> on_bus(std::vector<std::string> arguments) const {
    const std::vector<std::string> where = {"--domain", std::to_string(domain.domain),
                                            "--partition", domain.partition};
    arguments.insert(arguments.end(), where.begin(), where.end());
    return arguments;
  }
  [[nodiscard]] Process start(const std::vector<std::string>& arguments) const {
    return {on_bus(arguments), folder.file("started.out"), folder.file("started.err")};
  }
  [[nodiscard]] std::optional<int> mpm(std::vector<std::string> arguments,
                                       const std::string& input = "/dev/null") const {
    arguments.insert(arguments.begin(), "mpm");
    return run(on_bus(arguments), folder.file("out"), folder.file("err"), input);
  }
  [[nodiscard]] std::string out() const { return read_file(folder.file("out")); }
  [[nodiscard]] std::string err() const { return read_file(folder.file("err")); }
  [[nodiscard]] idl::UnitPublisher publisher() const {
    UnitLayout layout;
    layout.unit = "toy";
    layout[SignalKind::kMv].tags = {"u1", "u2"};
    layout[SignalKind::kCv].tags = {"y1"};
    return {participant, layout, idl::WriterPace::kLossless};
  }
  /// Publishes 50 frames a second while `process` runs; its exit code.
  [[nodiscard]] std::optional<int> publish_during(Process& process) const {
    const idl::UnitPublisher publisher = this->publisher();
    Plant plant(2.0);
    for (int i = 0; i < 1000; ++i) {
      REQUIRE(publisher.publish(plant.next()));
      if (const auto code = process.wait(std::chrono::milliseconds(20))) return code;
    }
    return std::nullopt;
  }
  /// A recording of `frames` frames, split if `options` say so.
  void record(const std::string& output, int frames, std::vector<std::string> options = {},
              std::chrono::milliseconds apart = {}) const {
    options.insert(options.begin(), {"mpm", "record", "--output", output});
    Process recorder = start(options);
    const idl::UnitPublisher publisher = this->publisher();
    REQUIRE(publisher.wait_for_readers(kPatience));
    Plant plant(2.0);
    for (int i = 0; i < frames; ++i) {
      REQUIRE(publisher.publish(plant.next()));
      std::this_thread::sleep_for(apart);
    }
    REQUIRE(publisher.flush(kPatience));
    recorder.send(SIGTERM);
    INFO(read_file(folder.file("started.err")));
    REQUIRE(recorder.wait(kPatience) == 0);
  }
  /// The mv samples that a replay into another corner brings, in order.
  struct Seen {
    std::string unit;
    std::int64_t interval;
    std::int64_t source_time_ns;  // that of DDS
  };
  [[nodiscard]] std::vector<Seen> replayed(const std::vector<std::string>& options,
                                           std::size_t expected) const {
    idl::DomainOptions elsewhere = domain;
    elsewhere.partition += "-replay";
    const idl::Participant other(elsewhere);
    idl::SampleReaders inputs(other);  // so that all five have a reader
    idl::Reader<mpm_Sample> reader(other, "mpm/mv", idl::sample_reader_qos());
    std::vector<std::string> arguments = {"mpm",         "replay",
                                          "--domain",    std::to_string(domain.domain),
                                          "--partition", elsewhere.partition};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Process replay(arguments, folder.file("out"), folder.file("err"));
    std::vector<Seen> seen;
    const bool complete = idl::eventually(
        [&] {
          inputs.take([](const idl::SampleView&) {});
          reader.take_with_info([&](const mpm_Sample& sample, const idl::SampleInfo& info) {
            if (info.valid) seen.push_back({sample.unit, sample.interval, info.source_time_ns});
          });
          return seen.size() >= expected;
        },
        kPatience);
    INFO(err());
    CHECK(complete);
    replay.send(SIGTERM);  // one that loops does not end by itself
    CHECK(replay.wait(kPatience) == 0);
    return seen;
  }

  TemporaryFolder folder;
  idl::DomainOptions domain;
  idl::Participant participant;
};

/// A program of ours with a terminal of its own; killed if the test leaves it behind.
class OnTerminal {
 public:
  explicit OnTerminal(const std::vector<std::string>& arguments) {
    const std::string program = std::string(MPM_BIN_DIR) + "/" + arguments.at(0);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments)
      argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      execv(program.c_str(), argv.data());
      _exit(127);
    }
    REQUIRE(pid_ > 0);
    fcntl(terminal_, F_SETFL, O_NONBLOCK);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;
  ~OnTerminal() {
    if (pid_ > 0) kill(pid_, SIGKILL);
    if (pid_ > 0) waitpid(pid_, nullptr, 0);
    close(terminal_);
  }
  void press(const std::string& keys) const {
    REQUIRE(write(terminal_, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
  }
  /// True once `text` has been shown, from where the last one was found.
  [[nodiscard]] bool shows(const std::string& text) {
    return idl::eventually(
        [&] {
          std::array<char, 4096> bytes;
          for (ssize_t count; (count = read(terminal_, bytes.data(), bytes.size())) > 0;)
            shown_.append(bytes.data(), static_cast<std::size_t>(count));
          const std::size_t found = shown_.find(text);
          if (found == std::string::npos) return false;
          shown_.erase(0, found + text.size());
          return true;
        },
        kPatience);
  }
  [[nodiscard]] int exit_code() {
    int status = 0;
    waitpid(std::exchange(pid_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_ = 0;
  int terminal_ = -1;
  std::string shown_;
};

/// True once the process asks for the signals that stop it instead of ending by them.
bool blocks_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (word == "SigBlk:" && status >> word)
      return (std::stoull(word, nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
  return false;
}

TEST_CASE("mpm topics lists who is on the bus, with types and units") {
  const Corner corner("topics");
  Process topics = corner.start({"mpm", "topics", "--json", "--duration", "1"});
  CHECK(corner.publish_during(topics) == 0);
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : nlohmann::json::parse(read_file(corner.folder.file("started.out"))))
    rows[row["topic"]] = row;
  REQUIRE(rows.size() == 3);
  CHECK(rows["mpm/mv"] == nlohmann::json({{"topic", "mpm/mv"},
                                          {"type", "mpm::Sample"},
                                          {"writers", 1},
                                          {"readers", 0},
                                          {"units", {"toy"}}}));
  CHECK(rows["mpm/layout"]["type"] == "mpm::Layout");
  CHECK(corner.mpm({"topics", "--duration", "0.3"}) == 0);
  CHECK(corner.out() == "nobody else is on this domain\n");
}

TEST_CASE("mpm echo prints samples and ends when it has enough") {
  const Corner corner("echo");
  Process echo = corner.start({"mpm", "echo", "mpm/mv", "--unit", "toy", "--count", "3", "--json"});
  CHECK(corner.publish_during(echo) == 0);
  const auto lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(lines.size() == 3);
  const auto first = nlohmann::json::parse(lines[0]), last = nlohmann::json::parse(lines[2]);
  CHECK(first["sample"]["unit"] == "toy");
  CHECK(first["sample"]["values"].size() == 2);
  CHECK(last["sample"]["interval"] == first["sample"]["interval"].get<int>() + 2);
  CHECK(corner.mpm({"echo", "mpm/mv", "--once", "--unit", "toy", "--duration", "0.2"}) == 2);
  CHECK(corner.err() == "mpm echo: no sample of mpm/mv of unit toy came\n");
  CHECK(corner.mpm({"echo", "mpm/nothing"}) == 3);
  CHECK(lines_of(corner.err()).size() == 1);
}

TEST_CASE("commands say that CYCLONEDDS_URI is set and not used") {
  const Corner corner("environment");
  const std::vector<std::string> uri = {"CYCLONEDDS_URI=file:///none"};
  const std::string out = corner.folder.file("out"), err = corner.folder.file("err");
  Process echo(corner.on_bus({"mpm", "echo", "mpm/mv", "--once", "--duration", "0.2"}), out, err,
               uri);
  CHECK(echo.wait(kPatience) == 2);
  CHECK(corner.err().find("mpm: CYCLONEDDS_URI is set, but not used; --dds-from-environment") == 0);
  Process status(corner.on_bus({"mpm", "status", "--wait", "0.2"}), out, err, uri);
  CHECK(status.wait(kPatience) == 2);
  CHECK(corner.out().find("(CYCLONEDDS_URI is set, but not used)") != std::string::npos);
}

TEST_CASE("mpm hz and delay measure a topic, also one that is not ours") {
  const Corner corner("hz");
  Process hz = corner.start({"mpm", "hz", "mpm/cv", "--json", "--duration", "1.5"});
  CHECK(corner.publish_during(hz) == 0);
  auto lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(!lines.empty());
  const auto rate = nlohmann::json::parse(lines.back());
  CHECK(rate["rate"].get<double>() > 20.0);  // 50, if the machine is not busy
  CHECK(rate["rate"].get<double>() < 60.0);
  CHECK(rate["window"].get<int>() > 20);
  Process delay = corner.start({"mpm", "delay", "mpm/cv", "--json", "--duration", "1"});
  CHECK(corner.publish_during(delay) == 0);
  lines = lines_of(read_file(corner.folder.file("started.out")));
  REQUIRE(!lines.empty());
  CHECK(nlohmann::json::parse(lines.back())["min"].get<double>() > 0.0);
  CHECK(nlohmann::json::parse(lines.back())["min"].get<double>() < 0.1);

  const idl::Writer<mpm_Health> foreign(corner.participant, "site/health", idl::health_qos());
  Process other = corner.start({"mpm", "hz", "site/health", "--duration", "1.5", "--json"});
  mpm_Health health{};
  char unit[] = "far";
  health.unit = unit;
  std::optional<int> code;
  while (!code) {
    REQUIRE(foreign.write(health));
    code = other.wait(std::chrono::milliseconds(20));
  }
  CHECK(code == 0);
  CHECK(corner.mpm({"hz", "mpm/cv", "--duration", "0.3"}) == 2);
  CHECK(corner.mpm({"hz", "--peer", "127.0.0.1", "mpm/cv", "--duration", "0.3s"}) == 2);
  CHECK(corner.mpm({"hz", "mpm/cv", "--duration", "nan"}) == 3);
  CHECK(corner.mpm({"hz", "mpm/nothing"}) == 3);
}

TEST_CASE("mpm hz and delay end in peace when the reader of their pipe has left") {
  const Corner corner("left");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const char* command : {"hz", "delay"}) {
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(reader >= 0);
    Process process(corner.on_bus({"mpm", command, "mpm/cv"}), pipe, corner.folder.file("err"));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(process.pid()); }, kPatience));
    close(reader);
    CHECK(corner.publish_during(process) == 0);
    CHECK(corner.err().empty());
  }
}

TEST_CASE("mpm echo and watch end when the reader of their pipe has left, though nothing comes") {
  const Corner corner("silent-left");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  for (const auto& arguments : {std::vector<std::string>{"mpm", "echo", "mpm/alarm"},
                                std::vector<std::string>{"mpm", "watch", "--json"}}) {
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    REQUIRE(reader >= 0);
    Process process(corner.on_bus(arguments), pipe, corner.folder.file("err"));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(process.pid()); }, kPatience));
    close(reader);
    CHECK(process.wait(kPatience) == 0);
    CHECK(corner.err().empty());
  }
}

TEST_CASE("lines on standard input become samples that the monitor judges as it would the file") {
  const Corner corner("publish");
  const std::string unit = MPM_SOURCE_DIR "/config/plants/shell3x3.yaml";
  const auto file = [&](const char* name) { return corner.folder.file(name); };
  REQUIRE(run({"mpmsim", "--config", unit, "--scenario", "hidden_gain", "--seed", "5", "--samples",
               "600", "--csv", file("run.csv")},
              file("sim.out"), file("sim.err")) == 0);
  REQUIRE(run({"mpm", "detect", "--config", unit, "--data", file("run.csv"),
               "--journal-every-sample", file("expected.jsonl")},
              file("detect.out"), file("detect.err")) == 0);
  const std::string expected = read_file(file("expected.jsonl"));

  // The same once more as JSON, one object per line.
  const std::vector<std::string> rows = lines_of(read_file(file("run.csv")));
  std::string json;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::istringstream names(rows[0]), cells(rows[i]);
    json += "{";
    for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');)
      json += (json.back() == '{' ? "\"" : ",\"") + name + "\":" + cell;
    json += "}\n";
  }
  write_file(file("run.jsonl"), json);

  for (const char* input : {"run.csv", "run.jsonl"}) {
    CAPTURE(input);
    const std::string journal = file("live.jsonl");
    std::filesystem::remove(journal);
    Process monitor = corner.start({"mpmd", "--config", unit, "--journal-every-sample", journal});
    CHECK(corner.mpm({"publish", "--config", unit}, file(input)) == 0);
    CHECK(idl::eventually([&] { return read_file(journal).size() >= expected.size(); }, kPatience));
    const bool same = read_file(journal) == expected;
    CHECK(same);
    monitor.send(SIGTERM);
    CHECK(monitor.wait(kPatience) == 0);
  }
}

TEST_CASE("mpm publish names the line that is wrong, and stops or goes on") {
  const Corner corner("publish_bad");
  const std::string unit = corner.folder.file("toy.yaml"), input = corner.folder.file("lines");
  const auto publish = [&](const std::string& lines, const std::string& on_error) {
    write_file(input, lines);
    return corner.mpm({"publish", "--config", unit, "--wait-readers", "0", "--on-error", on_error},
                      input);
  };
  const std::string bad_csv = "time,u1,u2,y1\n0,1,2,3\n1,1,2x,3\n2,1,2,3\n";
  CHECK(publish(bad_csv, "stop") == 3);
  CHECK(corner.err() == "stdin:3:5: error: '2x' is no number; leave empty what is missing\n");
  CHECK(publish(bad_csv, "skip") == 0);
  CHECK(lines_of(corner.err()).back() == "mpm publish: 2 lines published, 1 skipped");
  CHECK(publish("{\"time\":0,\"u1\":1}\n{\"time\":1,\"u1\":}\n", "stop") == 3);
  CHECK(corner.err() == "stdin:2:16: error: is no JSON\n");
  CHECK(publish("{\"u1\":1}\n[]\n{\"time\":0,\"u1\":1,\"u1.quality\":\"bad\"}\n", "skip") == 0);
  CHECK(lines_of(corner.err()).size() == 3);
  CHECK(publish("time,u1\n0,1\n", "stop") == 3);
  CHECK(publish("", "stop") == 3);
}

TEST_CASE("no line of JSON ends mpm publish --on-error skip, and each is told with its place") {
  const Corner corner("publish_json");
  const std::string deep(100'000, '['), undeep(100'000, ']');
  write_file(corner.folder.file("lines"),
             "{\"time\":1,\"u1\":1e400}\n"
             "{\"time\":2, \"u1\" : \"x\"}\n"
             "{\"time\":3,\"u1\":1,\"u1.quality\":\"so so\"}\n"
             "{\"time\":4,\"u1\":" +
                 deep + undeep +
                 "}\n"
                 "{\"u2\":1,\"time\":\"now\"}\n"
                 "{\"time\":5,\"interval\":1.5}\n"
                 "{\"time\":6,\"u1\":2}\n");
  const auto publish = [&](const std::string& on_error) {
    return corner.mpm({"publish", "--config", corner.folder.file("toy.yaml"), "--wait-readers", "0",
                       "--on-error", on_error},
                      corner.folder.file("lines"));
  };
  CHECK(publish("stop") == 3);
  CHECK(corner.err() == "stdin:1:16: error: 'u1' is out of range\n");
  CHECK(publish("skip") == 0);
  const std::vector<std::string> said = lines_of(corner.err());
  REQUIRE(said.size() == 7);
  CHECK(said[1] == "stdin:2:19: error: 'u1': \"x\" is no number");
  CHECK(said[2].find("stdin:3:31: error: 'u1.quality': \"so so\" is no quality") == 0);
  CHECK(said[3] == "stdin:4:16: error: 'u1': [...] is no number");
  CHECK(said[4].find("stdin:5:16: error: \"time\": 'now'") == 0);
  CHECK(said[5] == "stdin:6:22: error: \"interval\": 1.5 is no interval number");
  CHECK(said[6] == "mpm publish: 1 line published, 6 skipped");
}

TEST_CASE("mpm publish that is stopped before its first line has done nothing wrong") {
  const Corner corner("publish_idle");
  const std::string pipe = corner.folder.file("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int silent = open(pipe.c_str(), O_RDWR);  // so that no end comes
  REQUIRE(silent >= 0);
  for (const std::string begun : {"", "{\"time\":1,"}) {
    Process publish(corner.on_bus({"mpm", "publish", "--config", corner.folder.file("toy.yaml")}),
                    corner.folder.file("out"), corner.folder.file("err"), {}, pipe);
    REQUIRE(write(silent, begun.data(), begun.size()) == static_cast<ssize_t>(begun.size()));
    REQUIRE(idl::eventually([&] { return blocks_interrupts(publish.pid()); }, kPatience));
    publish.send(SIGINT);
    CHECK(publish.wait(kPatience) == 0);
    INFO(corner.err());
    CHECK(corner.err().find("error") == std::string::npos);
  }
  close(silent);
}

TEST_CASE("mpm publish takes a CSV without predictions and says what becomes of them") {
  const Corner corner("publish_bare");
  const std::string unit = corner.folder.file("predicted.yaml");
  std::string text = unit_yaml("toy");
  const std::string cv = "{tag: y1, ";
  text.replace(text.find(cv), cv.size(), cv + "prediction: yhat1, ");
  write_file(unit, text);
  write_file(corner.folder.file("lines"), "time,u1,u2,y1\n0,1,2,3\n");
  CHECK(corner.mpm({"publish", "--config", unit, "--wait-readers", "0"},
                   corner.folder.file("lines")) == 0);
  CHECK(corner.err().find("model simulates instead") != std::string::npos);
  CHECK(lines_of(corner.err()).back() == "mpm publish: 1 line published");
}

TEST_CASE(
    "a recording that was split replays as one, under another name and from where one wants") {
  const Corner corner("split");
  const std::string folder = corner.folder.file("recordings");
  corner.record(folder, 2000,
                {"--max-size", "100kB", "--chunk-size", "8kB", "--compression", "none"});
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files += entry.path().extension() == ".mcap";
  CHECK(files > 2);

  const auto all = corner.replayed({folder, "--rate", "0"}, 2000);
  REQUIRE(all.size() == 2000);
  for (std::size_t i = 0; i < all.size(); ++i) {
    REQUIRE(all[i].interval == static_cast<std::int64_t>(i) + 1);
    REQUIRE((i == 0 || all[i].source_time_ns > all[i - 1].source_time_ns));
  }
  const auto renamed = corner.replayed({folder, "--rate", "0", "--remap", "toy:=copy"}, 2000);
  REQUIRE(renamed.size() == 2000);
  CHECK(renamed.front().unit == "copy");
  CHECK(renamed.back().source_time_ns == all.back().source_time_ns);
}

TEST_CASE("a topic of somebody else is recorded by the type that its writer describes") {
  const Corner corner("foreign");
  const std::string file = corner.folder.file("run.mcap");
  const idl::Writer<mpm_Health> foreign(corner.participant, "site/health", idl::health_qos());
  Process recorder =
      corner.start({"mpm", "record", "--output", file, "--topics", "site/health", "site/nothing",
                    "--chunk-duration", "0.01", "--compression", "none"});
  mpm_Health health{};
  char unit[] = "far away";
  health.unit = unit;
  // Its reader is a best-effort one, which acknowledges nothing: repeat until the file has it.
  REQUIRE(idl::eventually(
      [&] { return foreign.write(health) && read_file(file).find(unit) != std::string::npos; },
      kPatience));
  recorder.send(SIGTERM);
  CHECK(recorder.wait(kPatience) == 0);
  CHECK(read_file(corner.folder.file("started.err")).find("nobody wrote site/nothing") !=
        std::string::npos);
  const auto messages = mcap::open_messages(file);
  int count = 0;
  for (mcap::Message message; messages->next(message); ++count) {
    REQUIRE(message.channel->topic == "site/health");
    REQUIRE(message.schema->name == "mpm::Health");
    REQUIRE(idl::unit_of(message.data) == unit);
  }
  CHECK(count > 0);
}

TEST_CASE("a replay in a loop goes on counting") {
  const Corner corner("loop");
  const std::string file = corner.folder.file("run.mcap");
  corner.record(file, 100);
  const auto seen = corner.replayed({file, "--rate", "0", "--loop"}, 350);
  REQUIRE(seen.size() >= 350);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    REQUIRE(seen[i].interval - seen[i - 1].interval == (i % 100 == 0 ? 2 : 1));
    REQUIRE(seen[i].source_time_ns > seen[i - 1].source_time_ns);
  }
}

/// Not in every container.
bool has_pseudo_terminals() {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0) return false;
  const bool usable = grantpt(terminal) == 0 && unlockpt(terminal) == 0 &&
                      ptsname(terminal) != nullptr && access(ptsname(terminal), R_OK) == 0;
  close(terminal);
  return usable;
}

TEST_CASE("keys steer a replay on a terminal") {
  if (!has_pseudo_terminals()) {
    WARN("SKIPPED: no pseudo-terminals here");
    return;
  }
  const Corner corner("keys");
  const std::string file = corner.folder.file("run.mcap");
  corner.record(file, 100, {},
                std::chrono::milliseconds(1));  // samples that come together replay so
  OnTerminal replay(corner.on_bus(
      {"mpm", "replay", file, "--wait-readers", "0", "--rate", "0.0001", "--start-paused"}));
  CHECK(replay.shows(" 0 samples  0.0001 x  paused"));
  replay.press("s");
  CHECK(replay.shows(" 1 sample "));
  replay.press("\x1b[C\x1b[C");
  CHECK(replay.shows(" 3 samples  0.0001 x  paused"));
  replay.press(" ");
  CHECK(replay.shows("0.0001 x\x1b"));
  replay.press(" +");
  CHECK(replay.shows("0.01 x  paused"));
  replay.press("q");
  CHECK(replay.shows("samples published"));
  CHECK(replay.exit_code() == 0);
}

TEST_CASE("a recorder keeps to its quota and never touches other files") {
  const Corner corner("quota");
  const std::string folder = corner.folder.file("recordings");
  std::filesystem::create_directories(folder);
  write_file(folder + "/other.mcap", std::string(500'000, 'x'));
  corner.record(folder, 12'000, {"--quota", "1MB", "--chunk-size", "4kB", "--compression", "none"});
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename() != "other.mcap") bytes += entry.file_size();
  CHECK(bytes <= 1'000'000);
  CHECK(bytes > 500'000);
  CHECK(std::filesystem::file_size(folder + "/other.mcap") == 500'000);
  CHECK(read_file(corner.folder.file("started.err")).find("deleted") != std::string::npos);
}

TEST_CASE("a replay that would publish nothing, or not as meant, says so and ends with 3") {
  const Corner corner("nothing");
  const std::string file = corner.folder.file("run.mcap");
  corner.record(file, 20);
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--unit", "zzz"},
                                                  {"--start-offset", "1h"},
                                                  {"--topics", "mpm/alarm"},
                                                  {"--remap", "zzz:=copy"},
                                                  {"--remap", "toy:=a", "--remap", "toy:=b"},
                                                  {"--start-paused"}}) {
    CAPTURE(options);
    std::vector<std::string> arguments = {"replay", file, "--wait-readers", "0"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    CHECK(corner.mpm(arguments) == 3);
    CHECK(lines_of(corner.err()).size() == 1);
  }
  for (const char* option : {"--rate", "--start-offset", "--duration", "--wait-readers"})
    for (const char* value : {"nan", "inf", "-1", "1e400", "x"}) {
      CAPTURE(option, value);
      CHECK(corner.mpm({"replay", file, option, value}) == 3);
      CHECK(corner.err().find(option) != std::string::npos);
    }
  CHECK(corner.mpm({"replay"}) == 3);
}

TEST_CASE("options of a replay leave its files alone wherever they stand") {
  const Corner corner("places");
  const std::string file = corner.folder.file("run.mcap");
  corner.record(file, 20);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--remap", "toy:=copy", file, "--rate", "0"},
        {"--topics", "mpm/mv,mpm/cv", file, "--rate", "0"},
        {"--topics", "mpm/mv", "mpm/cv", file, "--rate", "0"},
        {"--rate", "0", "--topics", "mpm/mv", "mpm/cv", file},
        {file, "--rate", "0", "--topics", "mpm/mv", "mpm/cv"}}) {
    CAPTURE(arguments);
    std::vector<std::string> all = {"replay", "--wait-readers", "0"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    CHECK(corner.mpm(all) == 0);
    CHECK(corner.err() == "mpm replay: 40 samples published\n");
  }
}

TEST_CASE("mpm record takes times and sizes with units and refuses what no file could keep to") {
  const Corner corner("units");
  const auto record = [&](const std::vector<std::string>& options) {
    std::vector<std::string> all = {"record", "--output", corner.folder.file("recordings")};
    all.insert(all.end(), options.begin(), options.end());
    return corner.mpm(all);
  };
  CHECK(record({"--duration", "0.005m", "--max-size", "1.5GB", "--max-duration", "1h", "--quota",
                "3GB", "--unit", "nope"}) == 0);
  CHECK(corner.err().find("no sample of unit nope came") != std::string::npos);
  CHECK(record({"--duration", "0.3"}) == 0);
  CHECK(corner.err().find("no sample came") != std::string::npos);
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--quota", "20kB"}, {"--max-size", "1kB"}}) {
    CHECK(record(options) == 3);
    CHECK(corner.err().find("at least") != std::string::npos);
  }
  CHECK(record({"--quota", "1MB", "--max-size", "600kB"}) == 3);
  for (const char* option : {"--duration", "--max-duration", "--chunk-duration", "--max-size"})
    for (const char* value : {"nan", "inf", "-1", "1e400", "1 parsec", ""}) {
      CAPTURE(option, value);
      CHECK(record({option, value}) == 3);
    }
}

TEST_CASE("what cannot be recorded or replayed is said in one line") {
  const Corner corner("refused");
  const auto file = [&](const char* name) { return corner.folder.file(name); };
  write_file(file("there.mcap"), "something");
  write_file(file("empty.mcap"), "");
  CHECK(corner.mpm({"record", "--output", file("there.mcap")}) == 3);
  CHECK(lines_of(corner.err()).size() == 1);
  CHECK(read_file(file("there.mcap")) == "something");
  CHECK(corner.mpm({"record"}) == 3);
  CHECK(corner.mpm({"record", "--output", "/dev/null/x"}) == 2);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"replay", file("there.mcap")},
        {"replay", file("empty.mcap")},
        {"replay", file("missing.mcap")},
        {"replay", corner.folder.file("")},
        {"replay", file("there.mcap"), "--topics", "nothing"},
        {"replay", file("there.mcap"), "--remap", "a=b"}}) {
    CAPTURE(arguments);
    CHECK(corner.mpm(arguments) == 3);
    CHECK(lines_of(corner.err()).size() == 1);
  }
}

}  // namespace
}  // namespace mpm::test
