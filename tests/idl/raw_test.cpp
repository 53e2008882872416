#include <array>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "idl/discovery.hpp"
#include "idl/raw_reader.hpp"
#include "idl/raw_writer.hpp"
#include "idl/reader.hpp"
#include "idl/writer.hpp"
#include "tests/idl/test_domain.hpp"

namespace mpm::idl {
namespace {

const KnownTopic& known(const char* name) { return *find_known_topic(name); }

std::vector<RawSample> take_all(RawReader& reader, std::size_t count) {
  std::vector<RawSample> samples;
  REQUIRE(eventually([&] {
    reader.take([&](RawSample& sample) { samples.push_back(std::move(sample)); });
    return samples.size() >= count;
  }));
  return samples;
}

mpm_Sample sample_of_unit(const char* unit, std::int64_t interval, std::array<double, 2>& values) {
  mpm_Sample sample{};
  sample.unit = const_cast<char*>(unit);
  sample.interval = interval;
  sample.source_time_ns = interval * 1'000'000'000;
  sample.values = {2, 2, values.data(), false};
  return sample;
}

TEST_CASE("raw samples keep bytes and time stamps on their way through a recording") {
  const Participant live(test_domain("raw_live")), recorder(test_domain("raw_live"));
  const Participant replayer(test_domain("raw_replay")), fresh(test_domain("raw_replay"));
  const KnownTopic& topic = known("mpm/mv");

  Writer<mpm_Sample> writer(live, topic.name, sample_writer_qos(WriterPace::kLossless));
  RawReader raw(recorder, topic);
  REQUIRE(eventually([&] { return writer.matched_readers() > 0 && raw.matched_writers() > 0; }));
  std::array<double, 2> values{1.5, -2.5};
  for (int k = 0; k < 5; ++k) REQUIRE(writer.write(sample_of_unit("reactor", k, values)));
  std::vector<RawSample> recorded = take_all(raw, 5);
  // Only now: an end that comes while data waits has the data's time, as Cyclone does not tell its.
  mpm_Sample key = sample_of_unit("reactor", 0, values);
  REQUIRE(dds_dispose(writer.get(), &key) == DDS_RETCODE_OK);
  recorded.push_back(take_all(raw, 1).front());
  REQUIRE(recorded.size() == 6);
  CHECK(recorded[4].valid);
  CHECK(unit_of(recorded[4].cdr) == "reactor");
  REQUIRE(stamp_of(recorded[4].cdr));
  CHECK(stamp_of(recorded[4].cdr)->interval == 4);
  CHECK(stamp_of(recorded[4].cdr)->source_time_ns == 4'000'000'000);
  CHECK_FALSE(recorded[5].valid);
  CHECK(recorded[5].state == InstanceState::kDisposed);
  CHECK(unit_of(recorded[5].cdr) == "reactor");

  const RawWriter again(replayer, topic, WriterPace::kLossless);
  RawReader second(fresh, topic);
  REQUIRE(eventually([&] { return again.matched_readers() > 0; }));
  REQUIRE(again.greet(std::chrono::seconds(10)));
  for (std::size_t i = 0; i < 5; ++i)
    REQUIRE(again.write(recorded[i].cdr, recorded[i].source_time_ns) == WriteResult::kWritten);
  std::vector<RawSample> replayed;
  for (RawSample& sample : take_all(second, 6))  // the greeting is of no unit
    if (!unit_of(sample.cdr).empty()) replayed.push_back(std::move(sample));
  REQUIRE(again.end_instance(recorded[5].cdr, recorded[5].state, recorded[5].source_time_ns) ==
          WriteResult::kWritten);
  replayed.push_back(take_all(second, 1).front());
  REQUIRE(replayed.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(replayed[i].cdr == recorded[i].cdr);
    CHECK(replayed[i].source_time_ns == recorded[i].source_time_ns);
    CHECK(replayed[i].state == recorded[i].state);
  }
}

TEST_CASE("a raw sample can be sent on under another unit, interval and time") {
  const Participant here(test_domain("raw_change")), there(test_domain("raw_change"));
  Writer<mpm_Sample> writer(here, "mpm/cv", sample_writer_qos(WriterPace::kLossless));
  RawReader raw(here, known("mpm/cv"));
  std::array<double, 2> values{1.5, -2.5};
  REQUIRE(writer.write(sample_of_unit("a", 7, values)));
  const RawSample recorded = take_all(raw, 1).front();

  const RawWriter again(here, known("mpm/cv"), WriterPace::kLossless);
  Reader<mpm_Sample> reader(there, "mpm/cv", sample_reader_qos());
  REQUIRE(eventually([&] { return again.matched_readers() > 1; }));  // raw is one
  REQUIRE(again.greet(std::chrono::seconds(10)));
  REQUIRE(again.write(recorded.cdr, 1234, {"a longer name", 100, 5'000}) == WriteResult::kWritten);
  bool seen = false;
  REQUIRE(eventually([&] {
    reader.take_with_info([&](const mpm_Sample& sample, const SampleInfo& info) {
      if (!info.valid) return;
      seen = true;
      CHECK(std::string(sample.unit) == "a longer name");
      CHECK(sample.interval == 107);
      CHECK(sample.source_time_ns == 7'000'005'000);
      CHECK(sample.values._length == 2);
      CHECK(sample.values._buffer[1] == -2.5);
      CHECK(info.source_time_ns == 1234);
    });
    return seen;
  }));
}

TEST_CASE("bytes that are no sample are refused") {
  const Participant participant(test_domain("raw_bad"));
  const RawWriter writer(participant, known("mpm/mv"), WriterPace::kLossless);
  std::vector<std::byte> bytes;
  CHECK(writer.write(bytes, 0) == WriteResult::kNotCdr);
  bytes = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  CHECK(writer.write(bytes, 0) == WriteResult::kNotCdr);
  bytes.resize(40, std::byte{0xff});  // a string of 4 GB
  CHECK(writer.write(bytes, 0) == WriteResult::kNotCdr);
  CHECK(unit_of(bytes).empty());
  CHECK_FALSE(stamp_of(bytes));
}

TEST_CASE("every known topic can be read and written raw, and has its IDL") {
  const Participant participant(test_domain("raw_all"));
  for (const KnownTopic& topic : known_topics()) {
    CAPTURE(topic.name);
    const RawWriter writer(participant, topic, WriterPace::kLossless);
    const RawReader reader(participant, topic);
    CHECK(writer.matched_readers() == 1);
    const std::string& name = reader.type_name();
    const std::string record = "struct " + name.substr(name.rfind(':') + 1) + " {";
    CHECK(idl_text().find(record) != std::string_view::npos);
  }
  CHECK(idl_text().find("#include") == std::string_view::npos);
}

TEST_CASE("discovery lists others' endpoints and can ask for a type") {
  const Participant here(test_domain("discovery")), there(test_domain("discovery"));
  const Discovery discovery(here);
  Writer<mpm_Health> writer(there, "site/health", health_qos());
  Reader<mpm_Sample> reader(there, "mpm/mv", sample_reader_qos());
  std::vector<Endpoint> found;
  REQUIRE(eventually([&] {
    found = discovery.endpoints();
    return found.size() >= 2;
  }));
  REQUIRE(found.size() == 2);
  CHECK(found[0].topic == "mpm/mv");
  CHECK_FALSE(found[0].writer);
  CHECK(found[1].topic == "site/health");
  CHECK(found[1].type == "mpm::Health");
  CHECK(found[1].writer);

  const DiscoveredType type = discovery.type_of("site/health");
  REQUIRE(type);
  RawReader raw(here, "site/health", type);
  CHECK(raw.type_name() == "mpm::Health");
  REQUIRE(eventually([&] { return writer.matched_readers() > 0 && raw.matched_writers() > 0; }));
  mpm_Health health{};
  char unit[] = "far";
  health.unit = unit;
  REQUIRE(writer.write(health));
  CHECK(unit_of(take_all(raw, 1).front().cdr) == "far");
  CHECK_FALSE(discovery.type_of("mpm/nothing"));
}

}  // namespace
}  // namespace mpm::idl
