#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>
#include <random>
#include <regex>

#include "idl/log.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test {
namespace {

/// Stands in for systemd's notification socket.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path) : fd_(socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    REQUIRE(bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  }
  ~NotifySocket() { close(fd_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// Everything said so far, one message per line.
  const std::string& heard() {
    char buffer[4096];
    for (ssize_t n; (n = recv(fd_, buffer, sizeof buffer, MSG_DONTWAIT)) > 0;)
      heard_.append(buffer, static_cast<std::size_t>(n)).append("\n");
    return heard_;
  }
  bool hears(const std::string& word) {
    return idl::eventually([&] { return heard().find(word) != std::string::npos; });
  }

 private:
  int fd_;
  std::string heard_;
};

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    ++found;
  return found;
}

}  // namespace

TEST_CASE("systemd is told when the daemon is ready, alive, well and stopping") {
  TemporaryFolder folder;
  NotifySocket socket(folder.file("notify"));
  Bench bench("notify", {"--state-dir", "/proc/none"},
              {"NOTIFY_SOCKET=" + folder.file("notify"), "WATCHDOG_USEC=300000"});
  CHECK(socket.hears("READY=1"));
  CHECK(socket.hears("STATUS=1 unit; channels: 0 match, 0 mismatch, 2 undetermined; 0 alarms"));
  CHECK(socket.hears("0 alarms; toy: reports of diagnoses cannot be kept: /proc/none"));
  CHECK(socket.hears("WATCHDOG=1"));
  bench.daemon.send(SIGHUP);
  CHECK(idl::eventually([&] {
    return read_file(bench.folder.file("mpmd.err"))
               .find(" info SIGHUP: the unit files were read") != std::string::npos;
  }));
  CHECK(socket.hears("RELOADING=1\n"));
  CHECK(idl::eventually([&] { return count(socket.heard(), "READY=1\n") == 2; }));
  CHECK(socket.heard().find("not reloaded") == std::string::npos);

  // One that cannot be taken: until one can be, the status says so.
  const std::string file = bench.folder.file("toy.yaml");
  write_file(file, unit_yaml("toy") + "no_such_key: 1\n");
  bench.daemon.send(SIGHUP);
  CHECK(socket.hears("; not reloaded: " + file + ":13:1: error: "));
  CHECK(idl::eventually([&] { return count(socket.heard(), "READY=1\n") == 3; }));
  write_file(file, unit_yaml("toy"));
  bench.daemon.send(SIGHUP);
  CHECK(idl::eventually([&] { return count(socket.heard(), "READY=1\n") == 4; }));
  const std::string& heard = socket.heard();
  CHECK(count(heard, "RELOADING=1\n") == 3);
  const std::size_t last = heard.rfind("STATUS=");
  CHECK(heard.substr(last, heard.find('\n', last) - last).find("not reloaded") ==
        std::string::npos);
  CHECK(socket.heard().find("STOPPING=1") == std::string::npos);
  bench.daemon.send(SIGINT);
  CHECK(bench.daemon.wait(std::chrono::seconds(1)) == 0);
  CHECK(socket.hears("STOPPING=1"));
}

TEST_CASE("the log has levels for journald where that reads it, and times and words elsewhere") {
  TemporaryFolder folder;
  const std::string unit = folder.file("nic.yaml"), err = folder.file("err");
  write_file(unit, unit_yaml("nic") + "dds: {interface: nosuchnic0}\n");
  write_file(err, "");
  struct stat status {};
  REQUIRE(stat(err.c_str(), &status) == 0);
  const std::string ours = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  const auto log_with = [&](const std::string& stream) {
    Process daemon({"mpmd", "--config", unit}, folder.file("out"), err,
                   {"JOURNAL_STREAM=" + stream});
    CHECK(daemon.wait(std::chrono::seconds(20)) == 2);
    return read_file(err);
  };
  const std::string plain = log_with(ours + "0");  // somebody else's
  CHECK(std::regex_search(plain, std::regex("^[0-9-]{10} [0-9:]{8} info mpmd ")));
  CHECK(std::regex_search(plain, std::regex("\n[0-9-]{10} [0-9:]{8} error mpmd: error: ")));
  const std::string prefixed = log_with(ours);
  CHECK(prefixed.rfind("<6>mpmd ", 0) == 0);
  CHECK(prefixed.find("\n<3>mpmd: error: ") != std::string::npos);
}

TEST_CASE("of two daemons on one folder the second one is refused, until the first is gone") {
  TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  write_file(folder.file("toy.yaml"), unit_yaml("toy"));
  const std::vector<std::string> plain = {"mpmd", "--config", folder.file("toy.yaml"),
                                          "--partition", idl::test_domain("locked").partition};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = plain;
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  const std::string state = folder.file("state"), journal = folder.file("journal");
  Process first(with({"--state-dir", state, "--journal", journal}), folder.file("first.out"),
                folder.file("first.err"));
  REQUIRE(idl::eventually([&] {
    return read_file(folder.file("first.err")).find("watching 2 channels") != std::string::npos;
  }));
  const std::string holder = " is held by process " + std::to_string(first.pid()) + " on host ";
  const std::vector<std::vector<std::string>> refused = {
      {"--state-dir", state},
      {"--state-dir", folder.file(".") + "/state", "--standby"},
      {"--journal", journal},
      {"--alarm-journal", state + "/alarms.sqlite"}};
  for (const std::vector<std::string>& more : refused) {
    CHECK(run(with(more), out, err) == 2);
    INFO(read_file(err));
    CHECK(lines_of(read_file(err)).size() == 1);
    CHECK(read_file(err).find(holder) != std::string::npos);
  }
  // Who only looks is not concerned, nor who takes folders of his own, or one for both.
  CHECK(run(with({"--state-dir", state, "--check"}), out, err) == 0);
  CHECK(run({"mpm", "journal", "--journal", state + "/alarms.sqlite", "--verify"}, out, err) == 0);
  {
    Process other(with({"--state-dir", folder.file("other"), "--journal", folder.file("other")}),
                  out, err);
    CHECK(idl::eventually(
        [&] { return read_file(err).find("watching 2 channels") != std::string::npos; }));
  }
  first.send(SIGKILL);
  REQUIRE(first.wait(std::chrono::seconds(10)));
  Process next(with({"--state-dir", state, "--journal", journal}), out, err);
  CHECK(idl::eventually(
      [&] { return read_file(err).find("watching 2 channels") != std::string::npos; }));
}

// As of who starts it by hand: a service manager masks more.
TEST_CASE("what the daemon writes is its own and its group's alone") {
  TemporaryFolder folder;
  const mode_t mask = ::umask(022);
  Bench bench("modes", {"--state-dir", folder.file("state"), "--journal", folder.file("journal"),
                        "--journal-every-sample", folder.file("samples.jsonl")});
  ::umask(mask);
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(4.0);
  bench.publish(publisher, plant, 600);
  CHECK(bench.observe([&] { return bench.health().frames == 600; }));
  bench.daemon.send(SIGTERM);
  CHECK(bench.daemon.wait(std::chrono::seconds(20)) == 0);
  for (const char* name :
       {"state/alarms.sqlite", "state/samples/toy", "journal/toy-000001.jsonl", "samples.jsonl"})
    CHECK(std::filesystem::exists(folder.file(name)));
  CHECK(open_to_others(folder.file(".")) == std::vector<std::string>{});
}

TEST_CASE("garbage from the network neither stops the daemon nor floods its log") {
  idl::set_log_handler({});  // the garbage hits this process as well
  Bench bench("garbage");
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    // Unicast ports of the first participants of the domain (RTPS 9.6.1.1).
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * bench.options.domain + 10 +
                                                        static_cast<int>(random() % 8)));
    std::string packet = "RTPS\x02\x05\x01\x10";
    for (std::size_t n = 12 + random() % 200; n > 0; --n)
      packet += static_cast<char>(random() % 256);
    sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&address),
           sizeof address);
  }
  close(fd);
  const idl::UnitPublisher publisher = bench.publisher(idl::WriterPace::kLossless);
  Plant plant(2.0);
  bench.publish(publisher, plant, 100);
  CHECK(bench.observe([&] { return bench.health().frames == 100; }));
  const std::vector<std::string> log = lines_of(read_file(bench.folder.file("mpmd.err")));
  INFO(log.size() << " lines, the last one: " << log.back());
  CHECK(log.size() < 60);
}

TEST_CASE("one daemon watches a folder of units, on several domains at once") {
  TemporaryFolder folder;
  const idl::DomainOptions here = idl::test_domain("several-a");
  const idl::DomainOptions there = idl::test_domain("several-b");
  const auto with_dds = [](const std::string& unit, const idl::DomainOptions& options) {
    return unit_yaml(unit) + "dds: {domain: " + std::to_string(options.domain) +
           ", partition: " + options.partition + "}\n";
  };
  std::filesystem::create_directory(folder.file("units"));
  write_file(folder.file("units/a1.yaml"), with_dds("a1", here));
  write_file(folder.file("units/a2.yaml"), with_dds("a2", here));
  write_file(folder.file("units/b.yaml"), with_dds("b", there));
  Process daemon({"mpmd", "--config", folder.file("units")}, folder.file("out"),
                 folder.file("err"));

  const auto units_on = [](const idl::DomainOptions& options, std::size_t expected) {
    const idl::Participant participant(options);
    idl::OutputReaders readers(participant);
    std::vector<std::string> units;
    (void)idl::eventually([&] {
      for (const idl::Output& output : readers.take())
        if (const auto* health = std::get_if<HealthRecord>(&output))
          if (std::find(units.begin(), units.end(), health->unit) == units.end())
            units.push_back(health->unit);
      return units.size() == expected;
    });
    std::sort(units.begin(), units.end());
    return units;
  };
  CHECK(units_on(here, 2) == std::vector<std::string>{"a1", "a2"});
  CHECK(units_on(there, 1) == std::vector<std::string>{"b"});
}

TEST_CASE("command lines end with the agreed exit codes") {
  TemporaryFolder folder;
  const std::string out = folder.file("out"), err = folder.file("err");
  write_file(folder.file("good.yaml"), unit_yaml("good"));
  write_file(folder.file("bad.yaml"), unit_yaml("bad") + "no_such_key: 1\n");

  CHECK(run({"mpmd", "--config", folder.file("good.yaml"), "--check"}, out, err) == 0);
  CHECK(run({"mpmd", "--config", folder.file("bad.yaml"), "--check"}, out, err) == 1);
  CHECK(read_file(out).find(folder.file("bad.yaml") + ":13:1: error: ") == 0);
  CHECK(run({"mpmd", "--config", folder.file("bad.yaml")}, out, err) == 3);
  CHECK(read_file(err).find(folder.file("bad.yaml") + ":13:1: error: ") == 0);
  CHECK(run({"mpmd", "--config", folder.file("none.yaml")}, out, err) == 3);
  CHECK(run({"mpmd"}, out, err) == 3);
  CHECK(run({"mpmd", "--config", folder.file("good.yaml"), "--print-config"}, out, err) == 0);
  CHECK(read_file(out).find("unit: good") != std::string::npos);
  CHECK(run({"mpmd", "--version"}, out, err) == 0);
  CHECK(read_file(out).find("Cyclone DDS 0.10.2") != std::string::npos);
  CHECK(run({"mpmd", "--config", folder.file("good.yaml"), "--journal-every-sample",
             "/no/such/folder/x"},
            out, err) == 2);
  const std::string token = folder.file("token");
  CHECK(run({"mpmd", "--config", folder.file("good.yaml"), "--token-file", token}, out, err) == 3);
  CHECK(read_file(err) ==
        "--token-file: error: token file " + token + ": No such file or directory\n");
  CHECK(run({"mpmd", "--config", folder.file("good.yaml"), "--token-file", token, "--check"}, out,
            err) == 1);
  const std::string unit = read_file(folder.file("good.yaml"));
  for (const bool check : {false, true}) {
    std::vector<std::string> command = {"mpmd", "--config", folder.file("good.yaml"),
                                        "--alarm-journal", folder.file("good.yaml")};
    if (check) command.emplace_back("--check");
    CHECK(run(command, out, err) == (check ? 1 : 3));
    CHECK(read_file(check ? out : err) == "--alarm-journal: error: " + folder.file("good.yaml") +
                                              ": holds something else than a journal of alarms\n");
    CHECK(read_file(folder.file("good.yaml")) == unit);
  }
  write_file(folder.file("nic.yaml"), unit_yaml("nic") + "dds: {interface: nosuchnic0}\n");
  CHECK(run({"mpmd", "--config", folder.file("nic.yaml")}, out, err) == 2);
  CHECK(read_file(err).find("nosuchnic0") != std::string::npos);  // Cyclone's reason is passed on
  CHECK(run({"mpm"}, out, err) == 3);
  CHECK(run({"mpm", "watch", "--no-such-option"}, out, err) == 3);
  CHECK(run({"mpm", "watch", "--partition", "nobody", "--until-alarm", "--for", "0.3"}, out, err) ==
        2);
  CHECK(read_file(err) == "mpm: no monitor was on domain 0, partition 'nobody'\n");
}

}  // namespace mpm::test
