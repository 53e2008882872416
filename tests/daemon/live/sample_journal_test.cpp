#include "daemon/live/sample_journal.hpp"

#include <catch2/catch.hpp>

#include "tests/system/process.hpp"

namespace mpm::live {

TEST_CASE("a journal says why its disk takes no more") {
  SampleJournal full("/dev/full");  // gives ENOSPC for ever
  CHECK(full.problem().empty());
  CHECK_FALSE(full.write(std::vector<ChannelRecord>(1), {}));
  CHECK(full.problem() == "No space left on device");

  const test::TemporaryFolder folder;
  SampleJournal journal(folder.file("journal.jsonl"));
  CHECK(journal.write(std::vector<ChannelRecord>(2), {}));
  CHECK(journal.problem().empty());
  CHECK(test::lines_of(test::read_file(folder.file("journal.jsonl"))).size() == 2);
}

}  // namespace mpm::live
