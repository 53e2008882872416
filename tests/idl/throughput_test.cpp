#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <thread>

#include "idl/sample_readers.hpp"
#include "idl/unit_publisher.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

constexpr SignalCounts kCounts{2, 0, 2, 0};

UnitLayout layout() {
  UnitLayout unit;
  unit.unit = "fast";
  unit[SignalKind::kMv].tags = {"u1", "u2"};
  unit[SignalKind::kCv].tags = {"y1", "y2"};
  return unit;
}

long resident_kb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
    if (word == "VmRSS:") {
      long kb = 0;
      status >> kb;
      return kb;
    }
  return 0;
}

}  // namespace

TEST_CASE("a lossless writer at full speed loses nothing to a reader, in order, in flat memory") {
  constexpr int kFrames = 100'000;
  const DomainOptions options = test_domain("lossless");
  const Participant reading(options);
  const Participant writing(options);
  SampleReaders readers(reading);
  WaitSet wait_set;
  readers.attach_to(wait_set);
  const UnitPublisher publisher(writing, layout(), WriterPace::kLossless);
  REQUIRE(publisher.wait_for_readers(std::chrono::seconds(10)));

  bool all_written = true;
  std::thread writer([&] {
    Frame frame(kCounts);
    for (int k = 0; k < kFrames; ++k) {
      frame.interval = k;
      all_written = publisher.publish(frame) && all_written;
    }
  });

  std::array<std::int64_t, kSignalKindCount> next{};
  std::int64_t max_skew = 0;
  long early_kb = 0;
  int count = 0;
  bool in_order = true;
  while (count < 2 * kFrames && wait_set.wait(std::chrono::seconds(5)))
    readers.take([&](const SampleView& sample) {
      ++count;
      auto& expected = next[static_cast<std::size_t>(sample.kind)];
      in_order = in_order && sample.interval == expected;
      expected = sample.interval + 1;
      max_skew = std::max(max_skew, std::abs(next[0] - next[2]));
      if (sample.interval == kFrames / 5) early_kb = resident_kb();
    });
  writer.join();
  WARN("skew " << max_skew << " intervals, memory " << early_kb << " -> " << resident_kb()
               << " kB");
  CHECK(all_written);
  CHECK(count == 2 * kFrames);
  CHECK(in_order);
  CHECK(max_skew < 1024);
  if (test::resident_memory_is_ours()) CHECK(resident_kb() - early_kb < 5000);
}

TEST_CASE("a writer that never pauses keeps no history for readers that follow") {
  const DomainOptions options = test_domain("history");
  const Participant reading(options), writing(options);
  Reader<mpm_ChannelStatus> reader(reading, kChannelStatusTopic, channel_status_reader_qos(), 1024);
  const Writer<mpm_ChannelStatus> writer(writing, kChannelStatusTopic, channel_status_writer_qos());
  REQUIRE(eventually([&] { return writer.matched_readers() > 0; }));
  const long before_kb = resident_kb();
  int count = 0;
  for (int k = 0; k < 300; ++k) {
    for (int channel = 0; channel < 35; ++channel) {
      std::string mv = std::to_string(channel), none;
      mpm_ChannelStatus status{};
      status.unit = status.cv = status.verdict = status.reason = none.data();
      status.mv = mv.data();
      REQUIRE(writer.write(status));
    }
    const bool followed = eventually([&] {
      reader.take([&](const mpm_ChannelStatus&) { ++count; });
      return count >= 35 * (k + 1);
    });
    REQUIRE(followed);
  }
  CHECK(count == 300 * 35);
  WARN("history took " << resident_kb() - before_kb << " kB");
  if (test::resident_memory_is_ours())
    CHECK(resident_kb() - before_kb < 15'000);  // 45 MB if all is kept
}

TEST_CASE("a real-time writer is never held up by a reader that takes nothing") {
  const DomainOptions options = test_domain("realtime");
  const Participant reading(options);
  const Participant writing(options);
  const SampleReaders frozen(reading);
  const UnitPublisher publisher(writing, layout(), WriterPace::kRealTime);
  REQUIRE(publisher.wait_for_readers(std::chrono::seconds(10)));

  // A writer that waited would wait for this reader in vain, and fail after its 10 s.
  Frame frame(kCounts);
  for (int k = 0; k < 30'000; ++k) {
    frame.interval = k;
    REQUIRE(publisher.publish(frame));
  }
}

}  // namespace mpm::idl
