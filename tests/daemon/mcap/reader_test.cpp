#include <rapidcheck.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "config/finding.hpp"
#include "daemon/mcap/format/crc32.hpp"
#include "daemon/mcap/read/ordered_reader.hpp"
#include "daemon/mcap/read/reader.hpp"
#include "daemon/mcap/read/scan.hpp"
#include "daemon/mcap/write/writer.hpp"
#include "tests/daemon/mcap/files.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {
namespace {

using mcap::Op;

std::vector<Kept> read_in_file_order(const std::string& path) {
  mcap::Reader reader(path);
  return read_all(reader);
}

std::vector<Kept> read_in_time_order(const std::string& path, const mcap::TimeRange& range = {}) {
  return read_all(*mcap::open_messages(path, range));
}

std::string error_of(const std::string& path) {
  try {
    static_cast<void>(read_in_time_order(path));
  } catch (const config::InputError& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("CRC-32 of the check string is the published one") {
  CHECK(mcap::crc32(bytes_of("123456789")) == 0xCBF43926U);
  CHECK(mcap::crc32({}) == 0);
  mcap::Crc32 pieces;
  pieces.add(bytes_of("1234"));
  pieces.add({});
  pieces.add(bytes_of("56789"));
  CHECK(pieces.value() == 0xCBF43926U);
}

TEST_CASE("A file that was written says the same when it is read") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  {
    mcap::Writer writer(path);
    const auto schema = writer.add_schema("mpm::Sample", "omgidl", "struct Sample {};");
    const auto mv = writer.add_channel(schema, "mpm/mv", "cdr", {{"qos", "reliable"}});
    const auto note = writer.add_channel(0, "note", "json");
    writer.write(mv, 1'000, 900, bytes_of("one"));
    writer.write(note, 1'001, 901, bytes_of("{}"));
    writer.write(mv, 1'002, 902, bytes_of(""));
    writer.write(mv, 1'003, 903, bytes_of("four"), 77);
    writer.write(mv, 1'004, 904, bytes_of("five"));
    writer.add_metadata("plant", {{"name", "shell"}});
    writer.finish();
    CHECK(writer.messages() == 5);
    CHECK(writer.bytes_written() == std::filesystem::file_size(path));
  }
  const std::vector<Kept> expected = {{"mpm/mv", "mpm::Sample", "one", 1'000, 900, 0},
                                      {"note", "", "{}", 1'001, 901, 0},
                                      {"mpm/mv", "mpm::Sample", "", 1'002, 902, 1},
                                      {"mpm/mv", "mpm::Sample", "four", 1'003, 903, 77},
                                      {"mpm/mv", "mpm::Sample", "five", 1'004, 904, 78}};
  CHECK(read_in_file_order(path) == expected);
  CHECK(read_in_time_order(path) == expected);
  CHECK(read_in_time_order(path, {1'001, 1'003}) ==
        std::vector<Kept>(expected.begin() + 1, expected.begin() + 3));
  mcap::Reader reader(path);
  static_cast<void>(read_all(reader));
  CHECK(reader.library() == "mpm");
  CHECK(reader.definitions().channel(1)->metadata.at("qos") == "reliable");
}

TEST_CASE("A file without a message is whole") {
  TemporaryFolder folder;
  const std::string path = folder.file("empty.mcap");
  mcap::Writer(path).finish();
  CHECK(read_in_time_order(path).empty());
  CHECK(read_in_file_order(path).empty());
}

TEST_CASE("A chunk closes by size, or by the age of the times it is given") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  mcap::WriterOptions options;
  options.chunk_bytes = 1'000;
  mcap::Writer writer(path, options);
  const auto channel = writer.add_channel(0, "t", "json");
  writer.write(channel, 0, 0, bytes_of("a"));
  writer.close_old_chunk(999'999'999);
  CHECK(writer.chunks() == 0);
  writer.close_old_chunk(1'000'000'000);
  CHECK(writer.chunks() == 1);
  writer.close_old_chunk(5'000'000'000);  // nothing is open
  CHECK(writer.chunks() == 1);
  writer.write(channel, 2'000'000'000, 0, bytes_of("b"));
  writer.write(channel, 2'999'999'999, 0, bytes_of("c"));
  CHECK(writer.chunks() == 1);
  writer.write(channel, 3'000'000'000, 0, bytes_of("d"));  // begins the third
  CHECK(writer.chunks() == 2);
  writer.write(channel, 3'000'000'001, 0, bytes_of(std::string(2'000, 'e')));
  CHECK(writer.chunks() == 3);
  // What was closed is on disk before the end.
  mcap::InputFile file(path);
  CHECK(mcap::scan(file).chunks.size() == 3);
  writer.finish();
  CHECK(read_in_time_order(path).size() == 5);
}

TEST_CASE("A writer refuses what no file can say") {
  TemporaryFolder folder;
  mcap::Writer writer(folder.file("a.mcap"));
  const auto channel = writer.add_channel(0, "t", "json");
  CHECK_THROWS_AS(writer.write(channel, -1, 0, {}), std::invalid_argument);
  CHECK_THROWS_AS(writer.write(channel, 0, -1, {}), std::invalid_argument);
  CHECK_THROWS_AS(writer.write(2, 0, 0, {}), std::invalid_argument);
  CHECK_THROWS_AS(writer.add_channel(1, "t", "json"), std::invalid_argument);
  CHECK_THROWS_AS(mcap::Writer(folder.file("no/such/folder.mcap")), std::runtime_error);
}

TEST_CASE("A full disk leaves what was whole") {
  // /dev/full takes nothing: the first record fails already.
  CHECK_THROWS_AS(mcap::Writer(std::string("/dev/full")), std::runtime_error);
}

TEST_CASE("Any messages come back in both orders") {
  setenv("RC_PARAMS", "seed=7 max_success=60", 0);
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  REQUIRE(rc::check([&] {
    mcap::WriterOptions options;
    options.compression = *rc::gen::element(mcap::Compression::kNone, mcap::Compression::kZstd);
    options.chunk_bytes = *rc::gen::inRange<std::size_t>(1, 4'000);
    options.chunk_age_ns = *rc::gen::inRange<std::int64_t>(1, 2'000);
    mcap::Writer writer(path, options);
    std::vector<mcap::ChannelId> channels;
    const int count = *rc::gen::inRange(1, 5);
    for (int i = 0; i < count; ++i) {
      const auto schema = writer.add_schema("s" + std::to_string(i), "jsonschema", "{}");
      channels.push_back(writer.add_channel(schema, "t" + std::to_string(i), "json"));
    }
    const auto texts =
        *rc::gen::container<std::vector<std::string>>(rc::gen::string<std::string>());
    std::vector<Kept> expected;
    for (const std::string& text : texts) {
      const auto i = *rc::gen::inRange<std::size_t>(0, channels.size());
      const auto log_ns = *rc::gen::inRange<std::int64_t>(0, 10'000);  // any order
      const auto sequence = *rc::gen::arbitrary<std::uint32_t>();
      writer.write(channels[i], log_ns, log_ns / 2, bytes_of(text), sequence);
      expected.push_back(
          {"t" + std::to_string(i), "s" + std::to_string(i), text, log_ns, log_ns / 2, sequence});
    }
    writer.finish();
    RC_ASSERT(read_in_file_order(path) == expected);
    std::stable_sort(expected.begin(), expected.end(),
                     [](const Kept& a, const Kept& b) { return a.log_time_ns < b.log_time_ns; });
    RC_ASSERT(read_in_time_order(path) == expected);
    const auto from = *rc::gen::inRange<std::int64_t>(0, 10'000);
    const auto to = *rc::gen::inRange<std::int64_t>(0, 10'000);
    std::erase_if(expected, [&](const Kept& kept) {
      return kept.log_time_ns < from || kept.log_time_ns >= to;
    });
    RC_ASSERT(read_in_time_order(path, {from, to}) == expected);
    mcap::InputFile file(path);
    RC_ASSERT(mcap::index_problem(file, mcap::scan(file), texts.size()).empty());
  }));
}

TEST_CASE("An index of many chunks goes through the disk unharmed") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  mcap::WriterOptions options;
  options.chunk_bytes = 1;  // a chunk per message
  mcap::Writer writer(path, options);
  const auto channel = writer.add_channel(0, "t", "json");
  constexpr int kMessages = 6'000;  // 0.7 MB of chunk indexes
  for (int i = 0; i < kMessages; ++i) writer.write(channel, i, i, bytes_of("{}"));
  writer.finish();
  mcap::InputFile file(path);
  const mcap::FileLayout layout = mcap::scan(file);
  CHECK(layout.chunks.size() == kMessages);
  CHECK(mcap::index_problem(file, layout, kMessages).empty());
  CHECK(mcap::index_problem(file, layout, kMessages - 1) != "");
  CHECK(read_in_time_order(path).size() == kMessages);
  // Nothing is left beside it.
  CHECK(
      std::distance(std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()),
                    std::filesystem::directory_iterator()) == 1);
}

TEST_CASE("Files by others are read: unpacked, lz4, no chunks, unknown records") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  const std::vector<Kept> expected = {{"a", "S", "1", 10, 10, 0}, {"b", "S", "2", 20, 20, 0}};
  const auto compression = GENERATE(as<std::string>{}, "", "lz4", "zstd", "none at all");
  HandMade file;
  file.record(Op{0x80}, "another program's");
  const bool chunked = compression != "none at all";
  if (chunked) file.begin_chunk();
  file.schema(3, "S");
  file.channel(0, 3, "a");  // 0 is a good channel id
  file.channel(9, 3, "b");
  file.schema(0, "to be ignored");
  file.message(0, 10, "1");
  file.message(9, 20, "2");
  if (chunked) file.end_chunk(compression, 10, 20);
  file.record(Op::kAttachment, "anything");
  file.record(Op{0x55}, "the future's");
  file.end();
  file.save(path);
  CHECK(read_in_file_order(path) == expected);
  CHECK(read_in_time_order(path) == expected);
}

TEST_CASE("Chunks that overlap, in any order, come out in time order") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  HandMade file;
  file.begin_chunk();
  file.schema(1, "S");
  file.channel(1, 1, "a");
  file.message(1, 50, "c1");
  file.message(1, 70, "c2");
  file.end_chunk("zstd", 50, 70);
  file.begin_chunk();
  file.channel(2, 1, "b");
  file.message(2, 60, "b2");
  file.message(2, 20, "b1");
  file.end_chunk("lz4", 20, 60, false);
  file.begin_chunk();
  file.message(1, 20, "a1");
  file.message(2, 50, "a2");
  file.end_chunk("", 20, 50);
  file.end();
  file.save(path);
  std::string order;
  for (const Kept& kept : read_in_time_order(path)) order += kept.data + ' ';
  CHECK(order == "b1 a1 c1 a2 b2 c2 ");  // equal times: in the order of the file
  order.clear();
  for (const Kept& kept : read_in_time_order(path, {50, 61})) order += kept.data + ' ';
  CHECK(order == "c1 a2 b2 ");
}

TEST_CASE("What is wrong with a file is told with its byte") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  const auto expect = [&](const HandMade& file, const std::string& what) {
    file.save(path);
    const std::string error = error_of(path);
    CAPTURE(error, what);
    CHECK(error.find(path + ": error: byte ") == 0);
    CHECK(error.find(what) != std::string::npos);
  };
  SECTION("no channel") {
    HandMade file;
    file.message(5, 1, "x");
    file.end();
    expect(file, "channel 5, which nothing describes");
  }
  SECTION("no schema") {
    HandMade file;
    file.channel(5, 6, "x");
    file.message(5, 1, "x");
    file.end();
    expect(file, "channel 5 names schema 6");
  }
  SECTION("a channel that changes") {
    HandMade file;
    file.channel(5, 0, "x");
    file.channel(5, 0, "y");
    file.end();
    expect(file, "channel 5 changes");
  }
  SECTION("a packing that nobody knows") {
    HandMade file;
    file.begin_chunk();
    file.end_chunk("brotli", 0, 0);
    file.end();
    expect(file, "'brotli', which is not known here");
  }
  SECTION("a packing with a line break, which a fuzzer found") {
    HandMade file;
    file.begin_chunk();
    file.end_chunk("\n\x1B[31m", 0, 0);
    file.end();
    expect(file, "'\\n\\x1b[31m', which is not known here");
  }
  SECTION("a chunk that lies about its times") {
    HandMade file;
    file.begin_chunk();
    file.channel(5, 0, "x");
    file.message(5, 100, "x");
    file.end_chunk("zstd", 1, 2);
    file.end();
    expect(file, "a time that it does not span");
  }
  SECTION("a time that no clock shows") {
    HandMade file;
    file.channel(5, 0, "x");
    file.message(5, ~0ULL, "x");
    file.end();
    expect(file, "beyond the year 2262");
  }
  SECTION("a record that claims more than there is") {
    HandMade file;
    file.record(Op::kMetadata, "abc");
    file.bytes()[file.bytes().size() - 4 - 3] = std::byte{0x40};  // a length of petabytes
    file.end();
    expect(file, "is cut off");
  }
  SECTION("a chunk that claims to unpack to more than memory should hold") {
    HandMade file;
    file.begin_chunk();
    file.end_chunk("zstd", 0, 0);
    file.end();
    const std::size_t chunk = 8 + 9 + 4 + 4 + 7 + 4;  // behind magic and header
    file.bytes()[chunk + 9 + 16 + 5] = std::byte{1};
    expect(file, "claims to unpack to");
  }
  SECTION("no MCAP at all") {
    write_file(path, "time,u1\n0,1\n");
    CHECK(error_of(path).find("is no MCAP file") != std::string::npos);
    write_file(path, "");
    CHECK(error_of(path).find("the file is empty") != std::string::npos);
    CHECK(error_of(folder.file("none.mcap")).find("no such file") != std::string::npos);
    CHECK(error_of("/tmp").find("is a folder") != std::string::npos);
  }
  SECTION("something behind the end") {
    HandMade file;
    file.end();
    file.bytes().push_back(std::byte{0});
    expect(file, "something follows the end");
  }
}

TEST_CASE("A chunk that cannot be unpacked is told so") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  HandMade file;
  file.begin_chunk();
  file.schema(1, "S");
  file.end_chunk("lz4", 0, 0, false);
  file.end();
  const std::array magic = {std::byte{0x04}, std::byte{0x22}, std::byte{0x4D}, std::byte{0x18}};
  const auto frame =
      std::search(file.bytes().begin(), file.bytes().end(), magic.begin(), magic.end());
  REQUIRE(frame != file.bytes().end());
  *frame = std::byte{0x05};
  file.save(path);
  CHECK_THAT(error_of(path),
             Catch::Matchers::Contains("a chunk cannot be unpacked (ERROR_frameType_unknown)"));
}

TEST_CASE("A pipe is refused at once, whether or not somebody will ever write to it") {
  TemporaryFolder folder;
  const std::string path = folder.file("pipe.mcap");
  REQUIRE(mkfifo(path.c_str(), 0600) == 0);
  CHECK(error_of(path) == path + ": error: is no regular file");
}

TEST_CASE("A bomb of zeros stops at the size it names") {
  TemporaryFolder folder;
  const std::string path = folder.file("a.mcap");
  HandMade file;
  file.begin_chunk();
  file.bytes().resize(50'000'000);
  file.end_chunk("zstd", 0, 0, false);
  file.end();
  const std::size_t size_field = 8 + 9 + 4 + 4 + 7 + 4 + 9 + 16;
  file.bytes()[size_field + 3] = std::byte{0};  // names 2 % of it
  file.bytes()[size_field + 2] = std::byte{0x0F};
  file.save(path);
  CHECK(error_of(path).find("unpacks to more than the") != std::string::npos);
}

}  // namespace
}  // namespace mpm::test
