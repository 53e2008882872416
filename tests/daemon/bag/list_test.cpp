#include "daemon/bag/list.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "config/finding.hpp"
#include "daemon/bag/record/recording_writer.hpp"
#include "idl/cdr.hpp"
#include "tests/system/process.hpp"

namespace mpm::bag::list_test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 1'700'000'000 * kSecond;

/// One sample a second of each unit in turn.
void record(RecordingOptions options, std::int64_t start_ns, int samples,
            const std::vector<std::string>& units) {
  RecordingWriter writer(options, start_ns);
  const std::size_t topic = writer.add_topic({"mpm/mv", "mpm::Sample", "text", 0, true});
  for (int k = 0; k < samples; ++k) {
    std::string unit = units[static_cast<std::size_t>(k) % units.size()];
    mpm_Sample sample{};
    sample.unit = unit.data();
    sample.interval = k;
    idl::CdrEncoder<mpm_Sample> encoder;
    const auto cdr = encoder.encode(sample);
    RecordedSample recorded{topic, start_ns + k * kSecond, {}};
    recorded.sample.cdr.assign(cdr.begin(), cdr.end());
    writer.write(recorded);
  }
  writer.finish();
}

}  // namespace

TEST_CASE("a list has each recording once: files, those that were split, and folders") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("two.mcap");
  record(options, kStart + 1000 * kSecond, 20, {"shell", "boiler"});
  options.output = folder.file("split.mcap");
  options.max_duration_ns = 10 * kSecond;
  record(options, kStart, 100, {"shell"});
  options = {};
  options.output = folder.file("saved/one.mcap");
  std::filesystem::create_directory(folder.file("saved"));
  record(options, kStart - 1000 * kSecond, 5, {"boiler"});
  test::write_file(folder.file("notes.txt"), "x");
  std::filesystem::create_directory(folder.file("empty"));

  const std::vector<ListedRecording> list = list_recordings(folder.file(""));
  REQUIRE(list.size() == 3);
  CHECK(list[0].name == "saved/");
  CHECK(list[0].messages == 5);
  CHECK(list[1].name == "split-*.mcap");
  CHECK(list[1].files.size() == 10);
  CHECK(list[1].messages == 100);
  CHECK(list[1].start_ns == kStart);
  CHECK(list[1].end_ns == kStart + 99 * kSecond);
  CHECK(list[1].units == std::set<std::string>{"shell"});
  CHECK(list[2].name == "two.mcap");
  CHECK(list[2].units == std::set<std::string>{"boiler", "shell"});
  CHECK(list[2].bytes == std::filesystem::file_size(folder.file("two.mcap")));
  for (const ListedRecording& recording : list) CHECK(recording.problem.empty());
}

TEST_CASE("what is cut off or no recording at all is listed with the reason") {
  const test::TemporaryFolder folder;
  RecordingOptions options;
  options.output = folder.file("torn.mcap");
  options.file.chunk_bytes = 1024;
  record(options, kStart, 200, {"shell"});
  const std::string whole = test::read_file(options.output);
  test::write_file(options.output, whole.substr(0, whole.size() / 2));
  test::write_file(folder.file("none.mcap"), "no recording");

  const std::vector<ListedRecording> list = list_recordings(folder.file(""));
  REQUIRE(list.size() == 2);
  CHECK(list[0].name == "none.mcap");
  CHECK_FALSE(list[0].start_ns);
  CHECK_FALSE(list[0].problem.empty());
  CHECK(list[1].start_ns == kStart);
  CHECK(list[1].messages > 10);
  CHECK(list[1].messages < 200);
  CHECK(list[1].units == std::set<std::string>{"shell"});
  CHECK(list[1].problem.find("mpm recover") != std::string::npos);
  CHECK_THROWS_AS(list_recordings(folder.file("nowhere")), config::InputError);
}

}  // namespace mpm::bag::list_test
