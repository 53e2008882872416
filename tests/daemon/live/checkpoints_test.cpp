#include "daemon/live/checkpoints.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/system/process.hpp"

namespace mpm::live::checkpoints_test {
namespace {

namespace fs = std::filesystem;

// Of the log: two samples fill a file, and every second file has a state before it.
constexpr std::uint64_t kKeep = SampleLog::kFiles;
constexpr std::uint64_t kFilesBetween = 2;
constexpr std::size_t kDoubles = std::size_t{1} << 19;  // four megabytes

/// How many samples came, and the sum of their numbers, beside much that stays.
struct Sums {
  std::int64_t count = 0, sum = 0;
  std::vector<double> ballast = std::vector<double>(kDoubles, 1.0);

  void archive(Archive& a) { a(count, sum, ballast); }
  void take(const BlockView* block) {
    if (block == nullptr) return;
    ++count;
    sum += block->interval;
  }
};

/// A process with its unit, which it ends without a word.
struct Process {
  explicit Process(const test::TemporaryFolder& folder)
      : checkpoints({folder.file("unit"), "meaning", "owner", kKeep, kFilesBetween}, "unit",
                    [this](Archive& a) { a(sums); }) {
    had_state = checkpoints.take_back();
    at_state = sums.count;
    checkpoints.recall([this](const BlockView* block) { sums.take(block); }, nullptr);
  }

  void push(std::int64_t k) {
    const std::vector<double> values = {0.5};
    const std::vector<std::uint8_t> quality = {0};
    const BlockView block{SignalKind::kCv, k, k, values, quality};
    checkpoints.push(block);
    sums.take(&block);
  }
  void written() {
    for (int i = 0; i < 1000 && states() == before; ++i) {
      checkpoints.poll();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    before = states();
  }
  [[nodiscard]] std::set<std::string> states() const {
    std::set<std::string> names;
    if (!fs::exists(checkpoints.folder())) return names;
    for (const auto& entry : fs::directory_iterator(checkpoints.folder()))
      if (const std::string name = entry.path().filename(); name.starts_with("state-"))
        names.insert(name);
    return names;
  }

  Sums sums;
  Checkpoints checkpoints;
  bool had_state = false;
  std::int64_t at_state = 0;
  std::set<std::string> before;
};

bool never() { return false; }

}  // namespace

TEST_CASE("a state is kept while nothing waits, and the next process judges only what came after") {
  const test::TemporaryFolder folder;
  {
    Process first(folder);
    CHECK_FALSE(first.had_state);
    CHECK_FALSE(first.checkpoints.rest(never));  // nothing has come
    first.push(1);
    CHECK_FALSE(first.checkpoints.rest(never));  // the file is not full
    first.push(2);
    CHECK(first.states().empty());
    CHECK(first.checkpoints.rest(never));
    first.written();
    CHECK(first.states() == std::set<std::string>{"state-000000000002"});
    for (std::int64_t k = 3; k <= 4; ++k) first.push(k);
    CHECK_FALSE(first.checkpoints.rest(never));  // full, but a state stands one file ago
    first.push(5);
  }
  Process second(folder);
  CHECK(second.had_state);
  CHECK(second.at_state == 2);
  CHECK(second.sums.count == 5);
  CHECK(second.sums.sum == 15);
}

TEST_CASE("whatever waits is let go first, after a megabyte at most") {
  const test::TemporaryFolder folder;
  Process process(folder);
  for (std::int64_t k = 1; k <= 2; ++k) process.push(k);
  int asked = 0;
  CHECK_FALSE(process.checkpoints.rest([&] { return ++asked == 3; }));
  CHECK(asked == 3);
  CHECK(process.states().empty());
  // Nothing has begun meanwhile: what comes is in the same file, until there is rest.
  asked = 0;
  CHECK(process.checkpoints.rest([&] { return ++asked > 6; }));
  CHECK(asked >= 4);  // four megabytes
  process.written();
  process.push(3);
  Process next(folder);
  CHECK(next.at_state == 2);
  CHECK(next.sums.sum == 6);
}

TEST_CASE("without any rest a state is kept all the same, later") {
  const test::TemporaryFolder folder;
  Process process(folder);
  // Due before file 2, and forced before the file that is two files later: 4.
  std::int64_t k = 0;
  while (process.states().empty() && k < 100) {
    process.push(++k);
    CHECK_FALSE(process.checkpoints.rest([] { return true; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  process.written();
  REQUIRE(process.states().count("state-000000000003") +
              process.states().count("state-000000000004") ==
          1);
  Process next(folder);
  CHECK(next.had_state);
  CHECK(next.sums.count == k);
  CHECK(next.sums.sum == k * (k + 1) / 2);
}

TEST_CASE("what no sample tells can have a state at the next rest") {
  const test::TemporaryFolder folder;
  {
    Process process(folder);
    process.push(1);
    CHECK_FALSE(process.checkpoints.rest(never));
    process.sums.sum = 1000;  // a person's doing
    process.checkpoints.want_state();
    CHECK(process.checkpoints.rest(never));
    process.written();
    CHECK_FALSE(process.checkpoints.rest(never));  // once
    process.push(2);
  }
  CHECK(Process(folder).sums.sum == 1002);
}

TEST_CASE("what was judged again at the start is not judged once more") {
  const test::TemporaryFolder folder;
  {
    Process process(folder);
    process.push(1);
  }
  {
    Process process(folder);
    CHECK_FALSE(process.had_state);
    CHECK(process.sums.count == 1);
    process.checkpoints.keep_now();
  }
  Process last(folder);
  CHECK(last.at_state == 1);
  CHECK(last.sums.count == 1);
}

}  // namespace mpm::live::checkpoints_test
