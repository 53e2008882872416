#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>

#include "idl/cdr.hpp"
#include "idl/sample_view.hpp"

namespace mpm::test {
namespace {

// mpm::Sample{"ab", interval 3, time 5, values {1.5}, quality {2}} laid out by hand: XCDR1 aligns
// 64-bit numbers to 8, XCDR2 to 4.
std::vector<std::byte> by_hand(int id) {
  std::vector<std::byte> data;
  const auto put = [&](std::uint64_t value, int size) {
    const bool big = (id & 1) == 0;
    for (int i = 0; i < size; ++i)
      data.push_back(static_cast<std::byte>(value >> (8 * (big ? size - 1 - i : i))));
  };
  for (const int byte : {0, id, 0, 0}) data.push_back(static_cast<std::byte>(byte));
  put(3, 4);
  for (const char c : {'a', 'b', '\0'}) data.push_back(static_cast<std::byte>(c));
  put(0, 1);  // 8 bytes behind the header: aligned for both versions
  put(3, 8);
  put(5, 8);
  put(1, 4);
  if (id < 2) put(0, 4);
  put(std::bit_cast<std::uint64_t>(1.5), 8);
  put(1, 4);
  put(2, 1);
  return data;
}

TEST_CASE("A sample is read from either version of CDR in either byte order") {
  idl::CdrDecoder<mpm_Sample> decoder;
  for (const int id : {0, 1, 6, 7}) {
    CAPTURE(id);
    const mpm_Sample* sample = decoder.decode(by_hand(id));
    REQUIRE(sample != nullptr);
    const idl::SampleView view = idl::view_of(SignalKind::kMv, *sample);
    CHECK(view.unit == "ab");
    CHECK(view.interval == 3);
    CHECK(view.source_time_ns == 5);
    REQUIRE(view.values.size() == 1);
    CHECK(view.values[0] == 1.5);
    REQUIRE(view.quality.size() == 1);
    CHECK(view.quality[0] == 2);
  }
  for (const int id : {2, 3, 8, 9, 10, 11, 64}) {  // not how a final type comes
    std::vector<std::byte> data = by_hand(1);
    data[1] = static_cast<std::byte>(id);
    CHECK(decoder.decode(data) == nullptr);
  }
}

TEST_CASE("What is encoded is decoded to the same bits") {
  Frame frame({.mv = 4});
  frame.interval = -7;
  frame.source_time_ns = 1'714'564'800'123'456'789;
  frame[SignalKind::kMv].values << 0.1, -0.0, std::numeric_limits<double>::denorm_min(),
      std::numeric_limits<double>::quiet_NaN();
  frame[SignalKind::kMv].quality = {Quality::kGood, Quality::kUncertain, Quality::kBad,
                                    Quality::kBad};
  idl::CdrEncoder<mpm_Sample> encoder;
  idl::CdrDecoder<mpm_Sample> decoder;
  for (const char* unit : {"", "a unit with a rather long name", "x"}) {  // memory is used again
    const mpm_Sample* sample =
        decoder.decode(encoder.encode(idl::sample_of(unit, frame, SignalKind::kMv)));
    REQUIRE(sample != nullptr);
    const idl::SampleView view = idl::view_of(SignalKind::kMv, *sample);
    CHECK(view.unit == unit);
    CHECK(view.interval == -7);
    CHECK(view.source_time_ns == frame.source_time_ns);
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): -0.0 and NaN, bit by bit
    CHECK(std::memcmp(view.values.data(), frame[SignalKind::kMv].values.data(), 32) == 0);
    CHECK(std::memcmp(view.quality.data(), frame[SignalKind::kMv].quality.data(), 4) == 0);
  }
}

TEST_CASE("Damaged samples are refused or read, never worse") {
  const std::vector<std::byte> whole = by_hand(1);
  idl::CdrDecoder<mpm_Sample> samples;
  idl::CdrDecoder<mpm_Layout> layouts;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<long>(size));
    CHECK(samples.decode(cut) == nullptr);
    CHECK(layouts.decode(cut) == nullptr);
  }
  std::vector<std::byte> huge = whole;
  huge[4 + 8 + 16 + 3] = std::byte{0x7F};  // two thousand million values
  CHECK(samples.decode(huge) == nullptr);
  std::mt19937_64 random(3);
  for (int round = 0; round < 100'000; ++round) {
    std::vector<std::byte> damaged = whole;
    for (int i = 0; i < 3; ++i)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    if (round % 2 == 0) damaged[1] = std::byte{9};
    if (const mpm_Sample* sample = samples.decode(damaged))
      CHECK(sample->values._length <= damaged.size() / 8);
    static_cast<void>(layouts.decode(damaged));
  }
}

// In XCDR2 Cyclone 0.10.2 counts four bytes for each number; the test's sanitizers see what it
// reads or turns round beyond.
TEST_CASE("a sequence of more numbers than there are bytes is refused") {
  idl::CdrDecoder<mpm_Sample> decoder;
  for (const int id : {6, 7}) {
    std::vector<std::byte> data = by_hand(id);
    const std::size_t count = 4 + 8 + 16 + (id == 6 ? 3 : 0);
    for (int numbers = 2; numbers <= 3; ++numbers) {
      data[count] = static_cast<std::byte>(numbers);
      CHECK(decoder.decode(data) == nullptr);
    }
  }
  std::string text = "tag";
  double value = 1.0;
  mpm_ChannelStatus status{};
  status.unit = status.mv = status.cv = status.verdict = status.reason = text.data();
  status.nonlinear.verdict = status.nonlinear.kind = text.data();
  status.partial_correlations._buffer = &value;
  status.partial_correlations._length = status.partial_correlations._maximum = 1;
  idl::CdrEncoder<mpm_ChannelStatus> encoder;
  const std::span<const std::byte> bytes = encoder.encode(status);
  std::vector<std::byte> whole(bytes.begin(), bytes.end());
  idl::CdrDecoder<mpm_ChannelStatus> channels;
  CHECK(channels.decode(whole) != nullptr);
  const std::byte one_of[] = {std::byte{0}, std::byte{0}, std::byte{0},    std::byte{0},
                              std::byte{0}, std::byte{0}, std::byte{0xF0}, std::byte{0x3F}};
  const auto number = std::search(whole.begin(), whole.end(), std::begin(one_of), std::end(one_of));
  REQUIRE(number - whole.begin() > 4);
  const auto left = static_cast<std::size_t>(whole.end() - number);
  number[-4] = static_cast<std::byte>(left / 4);
  CHECK(channels.decode(whole) == nullptr);
}

// Cyclone gives members that a shorter sample lacks their default. Of a struct it may only where
// that is final: it ends the program otherwise.
template <class T>
int read_of_all_lengths(const T& sample) {
  idl::CdrEncoder<T> encoder;
  const std::span<const std::byte> bytes = encoder.encode(sample);
  const std::vector<std::byte> whole(bytes.begin(), bytes.end());
  idl::CdrDecoder<T> decoder;
  int read = 0;
  constexpr std::size_t kBefore = 8;  // header, and the length of what follows
  for (std::size_t size = kBefore; size <= whole.size(); ++size) {
    std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<long>(size));
    const auto length = static_cast<std::uint32_t>(size - kBefore);
    std::memcpy(cut.data() + 4, &length, sizeof length);
    read += decoder.decode(cut) != nullptr ? 1 : 0;
  }
  return read;
}

TEST_CASE("a sample of a type that had fewer members is read") {
  std::string text = "tag";
  mpm_ChannelStatus status{};
  status.unit = status.mv = status.cv = status.verdict = status.reason = text.data();
  status.nonlinear.verdict = status.nonlinear.kind = text.data();
  CHECK(read_of_all_lengths(status) > 20);

  mpm_CvPerformance cv{};
  cv.cv = cv.unit = cv.setpoint = text.data();
  mpm_Performance performance{};
  performance.unit = text.data();
  performance.cvs._buffer = &cv;
  performance.cvs._length = performance.cvs._maximum = 1;
  CHECK(read_of_all_lengths(performance) > 5);
}

}  // namespace
}  // namespace mpm::test
