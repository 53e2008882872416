#include <fcntl.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <utility>

#include "daemon/mcap/read/ordered_reader.hpp"
#include "idl/raw_sample.hpp"
#include "tests/system/corner.hpp"

namespace mpm::test {
namespace {

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
