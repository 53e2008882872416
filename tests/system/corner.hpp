#pragma once

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "idl/sample_readers.hpp"
#include "tests/system/bench.hpp"

namespace mpm::test {

inline constexpr std::chrono::seconds kPatience{20};

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

/// True once the process asks for the signals that stop it instead of ending by them.
inline bool blocks_interrupts(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (word == "SigBlk:" && status >> word)
      return (std::stoull(word, nullptr, 16) >> (SIGINT - 1) & 1U) != 0;
  return false;
}

}  // namespace mpm::test
