#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/bag/info.hpp"
#include "daemon/bag/lifecycle.hpp"
#include "daemon/bag/record/recording_writer.hpp"
#include "daemon/mcap/read/ordered_reader.hpp"
#include "idl/cdr.hpp"
#include "tests/system/process.hpp"

namespace mpm::bag::recording_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 1'700'000'000 * kSecond;  // 2023-11-14T22:13:20Z

idl::RawSample raw(std::span<const std::byte> cdr, std::int64_t source_time_ns) {
  idl::RawSample sample;
  sample.cdr.assign(cdr.begin(), cdr.end());
  sample.source_time_ns = source_time_ns;
  return sample;
}

RecordedSample sample_of(std::size_t topic, std::string unit, std::int64_t interval,
                         std::int64_t time_ns) {
  std::vector<double> values(20, 0.5 * static_cast<double>(interval));
  mpm_Sample sample{};
  sample.unit = unit.data();
  sample.interval = interval;
  sample.values = {20, 20, values.data(), false};
  idl::CdrEncoder<mpm_Sample> encoder;
  return {topic, time_ns, raw(encoder.encode(sample), time_ns - 7)};
}

RecordedSample sample_of(std::size_t topic, std::string unit, std::int64_t interval) {
  return sample_of(topic, std::move(unit), interval, kStart + interval * kSecond);
}

RecordedSample layout_of(std::size_t topic, std::string kind, double sample_time_s) {
  std::string unit = "shell";
  mpm_Layout layout{};
  layout.unit = unit.data();
  layout.kind = kind.data();
  layout.sample_time_s = sample_time_s;
  idl::CdrEncoder<mpm_Layout> encoder;
  return {topic, kStart, raw(encoder.encode(layout), kStart)};
}

std::vector<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename());
  return {names.begin(), names.end()};
}

void write_bytes(const std::string& path, std::size_t count) {
  std::ofstream(path) << std::string(count, 'x');
}

}  // namespace

TEST_CASE("a full queue drops what comes and counts it") {
  SampleQueue queue(3 * (sizeof(RecordedSample) + 100));
  std::vector<RecordedSample> batch(5);
  for (RecordedSample& sample : batch) sample.sample.cdr.resize(100);
  queue.push(batch);
  CHECK(batch.empty());
  CHECK(queue.dropped() == 2);
  REQUIRE(queue.pop(batch, std::chrono::milliseconds(0)));
  CHECK(batch.size() == 3);
  batch.resize(1);
  queue.push(batch);  // there is room again
  CHECK(queue.dropped() == 2);
  queue.close();
  CHECK(queue.pop(batch, std::chrono::milliseconds(0)));
  CHECK_FALSE(queue.pop(batch, std::chrono::milliseconds(0)));
}

TEST_CASE("a recording's files are named by their start, or as asked") {
  const test::TemporaryFolder folder;
  RecordingFiles one(folder.file("run.mcap"), false, 0, kStart);
  CHECK(one.next() == folder.file("run.mcap"));
  RecordingFiles split(folder.file("run.mcap"), true, 0, kStart);
  CHECK(split.next() == folder.file("run-0001.mcap"));
  CHECK(split.next() == folder.file("run-0002.mcap"));
  RecordingFiles many(folder.file("new/er"), false, 0, kStart);
  CHECK(many.next() == folder.file("new/er/mpm-20231114T221320Z-0001.mcap"));
  write_bytes(folder.file("there.mcap"), 1);
  RecordingFiles there(folder.file("there.mcap"), false, 0, kStart);
  CHECK_THROWS_AS((void)there.next(), std::invalid_argument);
  CHECK_THROWS_WITH(RecordingFiles("/dev/full", false, 0, kStart),
                    Catch::StartsWith("/dev/full: a folder of that name cannot be made: "));
}

TEST_CASE("the quota takes the oldest of our files and no other") {
  const test::TemporaryFolder folder;
  write_bytes(folder.file("mpm-20200101T000000Z-0001.mcap"), 400);
  write_bytes(folder.file("mpm-20200101T000000Z-0002.mcap"), 400);
  const std::vector<std::string> others = {"mpm-20200101T000000Z-0001.mcap.bak",
                                           "mpm-20200101T000000Z-x.mcap", "mpm-2020.mcap",
                                           "notes.txt", "run.mcap"};
  for (const std::string& name : others) write_bytes(folder.file(name), 1000);

  RecordingFiles files(folder.file(""), true, 1000, kStart);
  files.make_room(300, kStart);  // 400 + 400 + 300 to come
  CHECK(files.deleted() == 1);
  const std::string first = files.next();
  write_bytes(first, 300);
  files.finished({first, 300, kStart, kStart, true});
  files.make_room(300, kStart);
  CHECK(files.deleted() == 1);
  const std::string second = files.next();
  write_bytes(second, 300);
  files.finished({second, 300, kStart, kStart, true});
  files.make_room(300, kStart);
  CHECK(files.deleted() == 2);
  files.make_room(5000, kStart);  // never everything
  CHECK(files.deleted() == 3);
  std::vector<std::string> expected = others;
  expected.push_back(std::filesystem::path(second).filename());
  std::sort(expected.begin(), expected.end());
  CHECK(names_in(folder.file("")) == expected);
}

TEST_CASE("what is kept for some time only does not take the recordings of others with it") {
  const test::TemporaryFolder folder;
  for (const char* name : {"mpm-20200101T000000Z-0001.mcap", "ring-20200101T000000Z-0001.mcap",
                           "ring-20200101T000000Z-0002.mcap"})
    write_bytes(folder.file(name), 10);  // no recordings: they count as ended at the start
  RecordingFiles files(folder.file(""), true, 0, kStart, 60 * kSecond);
  CHECK(files.next() == folder.file("ring-20231114T221320Z-0001.mcap"));
  files.make_room(0, kStart + 60 * kSecond);
  CHECK(files.deleted() == 0);
  files.make_room(0, kStart + 61 * kSecond);
  CHECK(names_in(folder.file("")) ==
        std::vector<std::string>{"mpm-20200101T000000Z-0001.mcap",
                                 "ring-20200101T000000Z-0002.mcap"});  // the newest stays
}

TEST_CASE("numbers go on behind those of earlier runs, which the quota counts and takes first") {
  const test::TemporaryFolder folder;
  for (const char* name : {"q-0002.mcap", "q-0009.mcap", "q-10000.mcap"})
    write_bytes(folder.file(name), 300);
  const std::vector<std::string> others = {"mpm-20200101T000000Z-0001.mcap",
                                           "q-001.mcap",
                                           "q-0001.mcap.bak",
                                           "q-0001x.mcap",
                                           "q.mcap",
                                           "qq-0001.mcap"};
  for (const std::string& name : others) write_bytes(folder.file(name), 1000);
  RecordingFiles files(folder.file("q.mcap"), true, 1000, kStart);
  files.make_room(300, kStart);  // 900 + 300 to come
  CHECK(files.next() == folder.file("q-10001.mcap"));
  CHECK(files.deleted() == 1);
  CHECK_FALSE(std::filesystem::exists(folder.file("q-0002.mcap")));
  write_bytes(folder.file("q-10002.mcap"), 1);  // by somebody else in the meantime
  CHECK(files.next() == folder.file("q-10003.mcap"));
  files.make_room(800, kStart);
  CHECK_FALSE(std::filesystem::exists(folder.file("q-0009.mcap")));
  CHECK(std::filesystem::exists(folder.file("q-10000.mcap")));  // the newest stays
  for (const std::string& name : others) CHECK(std::filesystem::exists(folder.file(name)));
}

TEST_CASE("split files are whole by themselves and lose nothing between them") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("");
  options.max_size_bytes = 20'000;
  options.file.chunk_bytes = 4096;
  options.file.compression = mcap::Compression::kNone;
  RecordingWriter recording(options, kStart);
  const std::size_t mv = recording.add_topic({"mpm/mv", "mpm::Sample", "text", 0, true});
  const std::size_t layout = recording.add_topic({"mpm/layout", "mpm::Layout", "text", 2, false});
  recording.write(layout_of(layout, "mv", 5.0));
  recording.write(layout_of(layout, "cv", 1.0));
  recording.write(layout_of(layout, "mv", 1.0));  // a correction
  for (std::int64_t k = 0; k < 500; ++k)
    if (k != 123) recording.write(sample_of(mv, "shell", k));
  recording.finish();
  CHECK(recording.totals().samples == 502);
  CHECK(recording.totals().missing_intervals == 1);
  const std::vector<std::string> names = names_in(folder.file(""));
  CHECK(names.size() > 3);
  CHECK(recording.totals().files == names.size());

  std::int64_t expected = 0;
  for (const std::string& name : names) {
    CHECK(std::filesystem::file_size(folder.file(name)) < 40'000);
    const auto messages = mcap::open_messages(folder.file(name));
    mcap::Message message;
    std::map<std::string, double> sample_times;
    while (messages->next(message)) {
      REQUIRE(message.schema != nullptr);
      CHECK(message.schema->encoding == "omgidl");
      if (message.channel->topic == "mpm/layout") {
        idl::CdrDecoder<mpm_Layout> decoder;
        const mpm_Layout* seen = decoder.decode(message.data);
        REQUIRE(seen != nullptr);
        sample_times[seen->kind] = seen->sample_time_s;
        continue;
      }
      const std::optional<idl::SampleStamp> stamp = idl::stamp_of(message.data);
      REQUIRE(stamp);
      if (expected == 123) ++expected;
      CHECK(stamp->interval == expected++);
      CHECK(message.log_time_ns - message.publish_time_ns == 7);
    }
    CHECK(sample_times == std::map<std::string, double>{{"cv", 1.0}, {"mv", 1.0}});
  }
  CHECK(expected == 500);
}

TEST_CASE("an interval that all topics of a unit lack is missing once") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("run.mcap");
  RecordingWriter recording(options, kStart);
  const std::size_t mv = recording.add_topic({"mpm/mv", "mpm::Sample", "text", 0, true});
  const std::size_t cv = recording.add_topic({"mpm/cv", "mpm::Sample", "text", 0, true});
  for (std::int64_t k = 0; k < 20; ++k) {
    if (k == 5 || k == 6) continue;
    recording.write(sample_of(mv, "shell", k));
    if (k != 15) recording.write(sample_of(cv, "shell", k));
    if (k != 10) recording.write(sample_of(cv, "other", k));
  }
  recording.finish();
  CHECK(recording.totals().missing_intervals == 3 + 3);
}

TEST_CASE("no absence is as long as numbers may leap: nothing is missing there") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("run.mcap");
  RecordingWriter recording(options, kStart);
  const std::size_t mv = recording.add_topic({"mpm/mv", "mpm::Sample", "text", 0, true});
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const std::vector<std::int64_t> intervals = {0, kMost, -kMost - 1, kMost, 1, 3, kMost, 4};
  std::int64_t time_ns = kStart;
  for (const std::int64_t interval : intervals)
    recording.write(sample_of(mv, "shell", interval, time_ns += kSecond));
  recording.finish();
  CHECK(recording.totals().missing_intervals == 1);
  const SampleTally told =
      inspect(folder.file("run.mcap")).units.at("shell").samples.at(SignalKind::kMv);
  CHECK(told.times.missing == 1);
  CHECK(told.times.gaps == 1);
}

TEST_CASE("a recording is split by time even where nothing comes") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("run.mcap");
  options.max_duration_ns = 60 * kSecond;
  RecordingWriter recording(options, kStart);
  recording.tick(kStart + 59 * kSecond);
  CHECK(recording.path() == folder.file("run-0001.mcap"));
  recording.tick(kStart + 60 * kSecond);
  CHECK(recording.path() == folder.file("run-0002.mcap"));
  recording.finish();
}

TEST_CASE("the end of an instance survives as JSON") {
  idl::RawSample sample = sample_of(0, "shell", 1).sample;
  sample.valid = false;
  for (const auto state : {idl::InstanceState::kDisposed, idl::InstanceState::kNoWriters}) {
    sample.state = state;
    const std::optional<Lifecycle> back = parse_lifecycle(lifecycle_text(sample));
    REQUIRE(back);
    CHECK(back->state == state);
    CHECK(back->key == sample.cdr);
  }
  CHECK(lifecycle_text(sample).find(R"("unit":"shell")") != std::string::npos);
  for (const char* text : {"", "{}", "[]", R"({"state":"disposed","key":"0"})",
                           R"({"state":"disposed","key":"0g"})", R"({"state":"x","key":""})"})
    CHECK_FALSE(parse_lifecycle(text));
}

}  // namespace mpm::bag::recording_test
