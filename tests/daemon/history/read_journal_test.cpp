#include "daemon/history/read_journal.hpp"

#include <catch2/catch.hpp>

#include "config/finding.hpp"
#include "daemon/history/digest_json.hpp"
#include "tests/daemon/history/sample_history.hpp"
#include "tests/system/process.hpp"

namespace mpm::history {
namespace {

std::string head_line(const std::string& unit, std::int64_t time_ns) {
  UnitHead head = test::sample_head();
  head.unit = unit;
  head.time_ns = time_ns;
  return line_of(head) + "\n";
}

std::string digest_line(std::int64_t time_ns) {
  return line_of("sample", test::sample_digest(time_ns, 1.0, 0.1)) + "\n";
}

struct Read {
  int heads = 0, digests = 0;
  std::vector<AlarmChangeNote> alarms;

  explicit Read(const std::string& path) {
    read_journal(path, {[this](const UnitHead&) { ++heads; }, [this](const Digest&) { ++digests; },
                        [this](const AlarmChangeNote& alarm) { alarms.push_back(alarm); }});
  }
};

std::string error_of(const std::string& path) {
  try {
    const Read read(path);
  } catch (const config::InputError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("a journal is read, but for a line that its writer did not end") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a-000001.jsonl");
  const std::string alarm =
      R"({"record":"alarm","unit":"sample","interval":3,"time_ns":5,"mv":"u","cv":"y","to":"active"})";
  const std::string whole = head_line("sample", 0) + "{\"record\":\"channel\",...\n" +
                            digest_line(0) + alarm + "\n" + "{\"record\":\"health\"}\n" +
                            "{\"record\":\"something new\"}\n";
  for (const std::string& torn : {std::string(), digest_line(900).substr(0, 50), alarm}) {
    test::write_file(path, whole + torn);
    const Read read(path);
    CHECK(read.heads == 1);
    CHECK(read.digests == 1);
    REQUIRE(read.alarms.size() == 1);
    CHECK(read.alarms[0].active);
    CHECK(read.alarms[0].time_ns == 5);
  }
}

TEST_CASE("what is no journal is refused at its line") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a-000001.jsonl");
  const std::string head = head_line("sample", 0);
  test::write_file(path, head + "{\"record\": \"digest\", x}\n");
  CHECK(error_of(path) == path + ":2:22: error: is no JSON");
  test::write_file(path, head + "[1, 2]\n");
  CHECK(error_of(path) == path + ":2:1: error: is no line of a journal");
  test::write_file(path, head + "{\"record\":\"digest\"}\n");
  CHECK(error_of(path) == path + ":2:1: error: is no digest of a journal");
  test::write_file(path, head + digest_line(0) + "{\"record\":\"alarm\",\"mv\":1}\n");
  CHECK(error_of(path) == path + ":3:1: error: is no alarm of a journal");
  CHECK(error_of(folder.file("none")) == folder.file("none") + ": error: no such file");
  test::write_file(path, head + std::string(5 << 20, 'x') + "\n");
  CHECK(error_of(path) == path + ":2:1: error: a line of more than 4 MiB");
}

TEST_CASE("the files of a journal are found, in the order of their time") {
  const test::TemporaryFolder folder, other;
  test::write_file(folder.file("shell-000002.jsonl"), head_line("shell", 200));
  test::write_file(folder.file("shell-000001.jsonl"), head_line("shell", 100));
  test::write_file(folder.file("shell-000003.jsonl"), "");  // nothing came yet
  test::write_file(folder.file("tank-000001.jsonl"), head_line("tank", 50));
  test::write_file(folder.file("notes.txt"), "no journal");
  const std::string place = folder.file("");
  CHECK(journal_of({place}, "shell") ==
        std::vector{folder.file("shell-000001.jsonl"), folder.file("shell-000002.jsonl")});
  CHECK_THROWS_WITH(journal_of({place}, ""), Catch::Contains("several units: say with --unit") &&
                                                 Catch::Contains("'shell', 'tank'"));
  CHECK_THROWS_WITH(journal_of({place}, "wood"), Catch::Contains("no journal of unit 'wood'"));
  CHECK_THROWS_WITH(journal_of({other.file("")}, ""), Catch::Contains("no journal in this folder"));
  CHECK(journal_of({folder.file("tank-000001.jsonl")}, "").size() == 1);
  test::write_file(other.file("a.jsonl"), "{\"record\":\"channel\"}\n");
  CHECK_THROWS_WITH(journal_of({other.file("a.jsonl")}, ""),
                    Catch::Contains("a.jsonl:1:1: error: does not begin as a journal does"));
}

}  // namespace
}  // namespace mpm::history
