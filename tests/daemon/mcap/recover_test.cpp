#include <catch2/catch.hpp>
#include <filesystem>
#include <random>

#include "config/finding.hpp"
#include "daemon/mcap/read/reader.hpp"
#include "daemon/mcap/recover.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "tests/daemon/mcap/files.hpp"
#include "tests/fuzz/exercise_mcap.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::recover_test {
namespace {

constexpr int kMessages = 40;
constexpr int kPerChunk = 8;

std::string text_of(int i) { return "message " + std::to_string(i) + std::string(30, 'x'); }

/// Five chunks of eight messages; returns the bytes.
std::string make_file(const std::string& path, mcap::Compression compression) {
  mcap::WriterOptions options;
  options.compression = compression;
  mcap::Writer writer(path, options);
  const auto schema = writer.add_schema("S", "jsonschema", "{}");
  const auto channel = writer.add_channel(schema, "a", "json", {{"k", "v"}});
  const auto other = writer.add_channel(0, "b", "json");
  for (int i = 0; i < kMessages; ++i) {
    if (i > 0 && i % kPerChunk == 0) writer.close_chunk();
    writer.write(i % 3 == 0 ? other : channel, i, i, bytes_of(text_of(i)));
  }
  writer.add_metadata("plant", {{"name", "shell"}});
  writer.finish();
  return read_file(path);
}

std::vector<Kept> messages_of(const std::string& path) {
  mcap::Reader reader(path);
  return read_all(reader);
}

TEST_CASE("A file that is cut off anywhere gives one error and is mended") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap"), cut = folder.file("cut.mcap"),
                    mended = folder.file("mended.mcap");
  const auto compression = GENERATE(mcap::Compression::kNone, mcap::Compression::kZstd);
  const std::string bytes = make_file(path, compression);
  const std::vector<Kept> all = messages_of(path);
  REQUIRE(all.size() == kMessages);
  std::size_t kept_before = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CAPTURE(length);
    write_file(cut, bytes.substr(0, length));
    exercise_mcap(cut, mended);
    if (length < 8) {
      CHECK_THROWS_AS(mcap::recover(cut, mended), config::InputError);
      continue;
    }
    const mcap::RecoverReport report = mcap::recover(cut, mended);
    const std::vector<Kept> kept = messages_of(mended);
    REQUIRE(kept.size() == report.messages);
    CHECK_FALSE(report.whole);
    // A prefix of the messages, growing with the length of the file.
    CHECK(std::equal(kept.begin(), kept.end(), all.begin()));
    CHECK(kept.size() >= kept_before);
    kept_before = kept.size();
    // Not packed, every whole message counts.
    if (compression == mcap::Compression::kNone && kept.size() < kMessages)
      CHECK(bytes.substr(0, length).find(text_of(static_cast<int>(kept.size()))) ==
            std::string::npos);
    std::filesystem::remove(mended);
  }
  CHECK(kept_before == kMessages);
}

TEST_CASE("Flipped bits never do more than give an error") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap"), flipped = folder.file("flipped.mcap"),
                    mended = folder.file("mended.mcap");
  std::mt19937_64 random(20240501);
  for (const auto compression : {mcap::Compression::kNone, mcap::Compression::kZstd}) {
    const std::string bytes = make_file(path, compression);
    for (int round = 0; round < 3'000; ++round) {
      std::string damaged = bytes;
      const std::size_t flips = 1 + random() % 4;
      for (std::size_t i = 0; i < flips; ++i)
        damaged[random() % damaged.size()] ^= static_cast<char>(1U << (random() % 8));
      write_file(flipped, damaged);
      CAPTURE(round);
      CHECK_NOTHROW(exercise_mcap(flipped, mended));
    }
  }
}

TEST_CASE("One bit wrong in a chunk is found") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap"), flipped = folder.file("flipped.mcap");
  const std::string bytes = make_file(path, mcap::Compression::kNone);
  std::size_t at = bytes.find(text_of(20));
  REQUIRE(at != std::string::npos);
  std::string damaged = bytes;
  damaged[at + 3] ^= 1;
  write_file(flipped, damaged);
  try {
    static_cast<void>(messages_of(flipped));
    FAIL("not found");
  } catch (const config::InputError& error) {
    CHECK(std::string(error.what()).find("its CRC is not right") != std::string::npos);
  }
  // The chunk goes, the others stay.
  const mcap::RecoverReport report = mcap::recover(flipped, folder.file("mended.mcap"));
  CHECK(report.messages == kMessages - kPerChunk);
  CHECK(report.problems.size() == 1);
  CHECK(report.lost_bytes > 0);
}

TEST_CASE("What goes wrong again and again is told once") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  std::string bytes = make_file(path, mcap::Compression::kZstd);
  mcap::InputFile file(path);
  mcap::RecordStream records(file);
  while (const auto head = records.next())
    if (head->op == mcap::Op::kChunk) bytes[head->content() + 24] ^= 1;  // of its CRC
  write_file(path, bytes);
  const mcap::RecoverReport report = mcap::recover(path, folder.file("mended.mcap"));
  CHECK(report.messages == 0);
  REQUIRE(report.problems.size() == 1);
  CHECK_THAT(report.problems[0], Catch::Matchers::Contains(" more of the kind up to byte "));
}

TEST_CASE("What comes behind a damaged length is found again") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap"), damaged_path = folder.file("damaged.mcap");
  std::string bytes = make_file(path, mcap::Compression::kZstd);
  // The first chunk's record: its opcode behind the channels, then its length.
  mcap::InputFile file(path);
  mcap::RecordStream records(file);
  std::vector<std::uint64_t> chunks;
  while (const auto head = records.next())
    if (head->op == mcap::Op::kChunk) chunks.push_back(head->offset);
  REQUIRE(chunks.size() == kMessages / kPerChunk);
  bytes[chunks[1] + 6] = 0x7F;
  write_file(damaged_path, bytes);
  const mcap::RecoverReport report = mcap::recover(damaged_path, folder.file("mended.mcap"));
  CHECK(report.messages == kMessages - kPerChunk);
  CHECK(report.lost_bytes >= chunks[2] - chunks[1]);
  CHECK(messages_of(folder.file("mended.mcap")).size() == kMessages - kPerChunk);
}

TEST_CASE("Mending a whole file changes none of its messages") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap"), mended = folder.file("mended.mcap");
  static_cast<void>(make_file(path, mcap::Compression::kZstd));
  const mcap::RecoverReport report = mcap::recover(path, mended);
  CHECK(report.whole);
  CHECK(report.lost_bytes == 0);
  CHECK(report.chunks == kMessages / kPerChunk);
  CHECK(messages_of(mended) == messages_of(path));
}

}  // namespace
}  // namespace mpm::test::recover_test
