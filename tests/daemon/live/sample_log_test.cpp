#include "daemon/live/sample_log.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <limits>
#include <random>

#include "tests/system/process.hpp"

namespace mpm::live::sample_log_test {
namespace {

namespace fs = std::filesystem;

/// What came back, in words: kind, interval, time, values, qualities; "expired".
struct Told {
  std::vector<std::string> lines;
  std::string why;
};

std::string text_of(const BlockView& block) {
  std::string text = std::to_string(static_cast<int>(block.kind)) + " " +
                     std::to_string(block.interval) + " " + std::to_string(block.source_time_ns);
  for (const double value : block.values) text += " " + std::to_string(value);
  for (const std::uint8_t code : block.quality) text += " q" + std::to_string(code);
  return text;
}

Told recall(SampleLog& log) {
  Told told;
  told.why = log.recall([&](const BlockView* block) {
    told.lines.push_back(block == nullptr ? "expired" : text_of(*block));
  });
  return told;
}

Told recall(const std::string& folder, const std::string& meaning = "a") {
  SampleLog log(folder, meaning, 1000);
  return recall(log);
}

/// Block k of a kind; what it says goes to `lines`.
void push(SampleLog& log, SignalKind kind, std::int64_t k, std::vector<std::string>* lines) {
  const std::vector<double> values = {static_cast<double>(k), -0.0,
                                      std::numeric_limits<double>::infinity()};
  const std::vector<std::uint8_t> quality = {0, 1, 2};
  const BlockView block{kind, k, k * 1'000'000'000, values, quality};
  log.push(block);
  if (lines != nullptr) lines->push_back(text_of(block));
}

std::vector<fs::path> files_of(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// A file holds a 64th of what is kept, of 640 intervals ten and the one that is too many.
TEST_CASE("a file says that it begins, and what it and the later ones hold comes back alone") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  std::vector<std::pair<std::uint64_t, std::size_t>> begun;  // file, lines before it
  std::vector<std::string> lines;
  {
    SampleLog log(place, "a", 640);
    for (int k = 0; k < 50; ++k) {
      const std::vector<double> values = {static_cast<double>(k)};
      const BlockView block{SignalKind::kMv, k, 0, values, {}};
      if (const auto file = log.push(block)) begun.emplace_back(*file, lines.size());
      lines.push_back(text_of(block));
    }
  }
  REQUIRE(begun.size() == 5);
  CHECK(begun[2] == std::pair<std::uint64_t, std::size_t>{3, 22});
  for (const auto& [file, before] : begun) {
    SampleLog log(place, "a", 640);
    CHECK(log.files() == std::vector<std::uint64_t>{1, 2, 3, 4, 5});
    std::vector<std::string> told, earlier;
    const auto into = [](std::vector<std::string>& texts) {
      return [&texts](const BlockView* block) { texts.push_back(text_of(*block)); };
    };
    CHECK(log.recall(into(told), file, into(earlier)).empty());
    const auto parted = lines.begin() + static_cast<std::ptrdiff_t>(before);
    CHECK(told == std::vector<std::string>(parted, lines.end()));
    CHECK(earlier == std::vector<std::string>(lines.begin(), parted));
  }
}

TEST_CASE("what was taken comes back as it came, over several lives") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  std::vector<std::string> lines;
  for (int life = 0; life < 3; ++life) {
    SampleLog log(place, "a", 1000);
    CHECK(recall(log).lines == lines);
    for (int k = 0; k < 100; ++k) {
      push(log, SignalKind::kMv, 100 * life + k, &lines);
      push(log, SignalKind::kCv, 100 * life + k, &lines);
    }
    log.push_expiry();
    lines.emplace_back("expired");
    CHECK(log.problem().empty());
  }
  const Told told = recall(place);
  CHECK(told.lines == lines);
  CHECK(told.why.empty());
}

TEST_CASE("the files behind a state stay, within a limit, until there is a later one") {
  const test::TemporaryFolder folder;
  SampleLog log(folder.file("samples"), "a", 640);
  auto push_until = [&log, k = std::int64_t{0}](std::int64_t end) mutable {
    for (; k < end; ++k) push(log, SignalKind::kMv, k, nullptr);
  };
  log.hold_from(3);
  push_until(3000);
  CHECK(log.files().front() == 3);
  push_until(9000);
  CHECK(log.files().size() * 11 > 8 * 640);  // a file holds 11 intervals
  CHECK(log.files().size() * 11 < 8 * 640 + 3 * 11);
  log.hold_from(log.files().back());
  push_until(9020);
  CHECK(log.files().size() * 11 < 640 + 3 * 11);
}

TEST_CASE("the last intervals stay, and not much more") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  SampleLog log(place, "a", 640);
  (void)recall(log);
  constexpr std::int64_t kAll = 5000;
  for (std::int64_t k = 0; k < kAll; ++k) {
    push(log, SignalKind::kMv, k, nullptr);
    push(log, SignalKind::kCv, k, nullptr);
  }
  const Told told = recall(place);
  CHECK(told.lines.size() >= 2 * 640);
  CHECK(told.lines.size() <= 2 * (640 + 3 * 11));  // a file holds 11 intervals
  CHECK(told.lines.back().starts_with("2 4999"));
}

TEST_CASE("who may not read the state does not") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  SampleLog log(place, "a", 100);
  push(log, SignalKind::kMv, 1, nullptr);
  struct stat file {
  }, made{};
  REQUIRE(::stat(files_of(place).front().c_str(), &file) == 0);
  REQUIRE(::stat(place.c_str(), &made) == 0);
  CHECK((file.st_mode & 07) == 0);
  CHECK((made.st_mode & 07) == 0);
}

TEST_CASE("what was kept with another meaning goes, with a word") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  {
    SampleLog log(place, "a", 1000);
    push(log, SignalKind::kMv, 1, nullptr);
  }
  const Told other = recall(place, "b");
  CHECK(other.lines.empty());
  CHECK(other.why == "the unit file has changed what it means");
  CHECK(files_of(place).empty());
  CHECK(recall(place, "a").lines.empty());
}

// Torn by a power cut, or damaged: what is before it in the file comes back, of that file nothing
// behind it, and of the other files all.
TEST_CASE("damage anywhere takes no more than the rest of its file") {
  const test::TemporaryFolder folder;
  std::mt19937 random(20'260);
  for (int round = 0; round < 300; ++round) {
    const std::string place = folder.file("r" + std::to_string(round));
    std::vector<std::string> lines;
    std::vector<std::size_t> ends;  // lines up to the end of each file
    for (int life = 0; life < 3; ++life) {
      SampleLog log(place, "a", 1000);
      (void)recall(log);
      for (int k = 0; k < 5; ++k) push(log, SignalKind::kMv, 5 * life + k, &lines);
      ends.push_back(lines.size());
    }
    const std::vector<fs::path> files = files_of(place);
    REQUIRE(files.size() == 3);
    const std::size_t hurt = random() % 3;
    std::string bytes = test::read_file(files[hurt].string());
    const std::size_t at = random() % bytes.size();
    if (random() % 2 == 0)
      bytes.resize(at);
    else
      bytes[at] = static_cast<char>(bytes[at] ^ (1 + static_cast<char>(random() % 255)));
    test::write_file(files[hurt].string(), bytes);

    SampleLog log(place, "a", 1000);
    const Told told = recall(log);
    CAPTURE(round, hurt, at, told.why);
    const std::size_t begin = hurt == 0 ? 0 : ends[hurt - 1];
    REQUIRE(told.lines.size() <= lines.size());
    const std::size_t lost = lines.size() - told.lines.size();
    REQUIRE(lost <= ends[hurt] - begin);
    std::vector<std::string> expected = lines;
    const auto gone = expected.begin() + static_cast<std::ptrdiff_t>(ends[hurt]);
    expected.erase(gone - static_cast<std::ptrdiff_t>(lost), gone);
    CHECK(told.lines == expected);
    // And it goes on.
    push(log, SignalKind::kMv, 99, &expected);
    CHECK(recall(place).lines == expected);
  }
}

// As file systems leave a file that had grown before a power cut and was not written.
TEST_CASE("zeros at the end of a file are damage, and nothing that happened") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  std::vector<std::string> lines;
  {
    SampleLog log(place, "a", 1000);
    push(log, SignalKind::kMv, 1, &lines);
  }
  const std::string file = files_of(place).front().string();
  test::write_file(file, test::read_file(file) + std::string(4096, '\0'));
  const Told told = recall(place);
  CHECK(told.lines == lines);
  CHECK(told.why == file + ": some of it is damaged");
}

TEST_CASE("a file that cannot be read is told, and the others come back") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  std::vector<std::string> lines;
  for (int life = 0; life < 3; ++life) {
    SampleLog log(place, "a", 1000);
    (void)recall(log);
    push(log, SignalKind::kMv, life, &lines);
  }
  const std::vector<fs::path> files = files_of(place);
  REQUIRE(files.size() == 3);
  fs::remove(files[0]);
  fs::create_directory(files[0]);
  const Told one = recall(place);
  CHECK(one.lines == std::vector<std::string>{lines[1], lines[2]});
  CHECK(one.why == files[0].string() + " cannot be read: Is a directory");
  fs::remove(files[2]);
  REQUIRE(::mkfifo(files[2].c_str(), 0600) == 0);
  const Told two = recall(place);
  CHECK(two.lines == std::vector<std::string>{lines[1]});
  CHECK(two.why == one.why + ", and 1 file more like it");
  SampleLog::sync(place);  // does not wait for whoever writes to the pipe

  SampleLog log(place, "a", 1000);
  std::vector<std::string> after = {lines[1]};
  (void)recall(log);
  push(log, SignalKind::kMv, 9, &after);
  CHECK(log.problem().empty());
  CHECK(recall(place).lines == after);
}

/// Files of this process end there, as on a disk that is full.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &before_) == 0);
    const rlimit limit{bytes, before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_CASE("a disk that is full is a problem told; what came before and after it is kept") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  SampleLog log(place, "a", 64);  // two blocks of a kind a file
  std::vector<std::string> lines, none;
  push(log, SignalKind::kMv, 1, &lines);
  std::string problem;
  {
    const FileLimit full(std::filesystem::file_size(files_of(place).front()) + 10);
    push(log, SignalKind::kMv, 2, &none);
    problem = log.problem();
  }
  CHECK_THAT(problem, Catch::Matchers::Contains("cannot be written: No space left on device"));
  push(log, SignalKind::kMv, 3, &lines);
  CHECK(log.problem().empty());
  CHECK(recall(place).lines == lines);
}

TEST_CASE("a folder that cannot be made is a problem told, and no more") {
  const test::TemporaryFolder folder;
  test::write_file(folder.file("file"), "");
  SampleLog log(folder.file("file") + "/samples", "a", 64);
  CHECK(recall(log).lines.empty());
  push(log, SignalKind::kMv, 1, nullptr);
  CHECK_THAT(log.problem(), Catch::Matchers::Contains("cannot be made"));
  fs::remove(folder.file("file"));
  for (int k = 2; k < 5; ++k) push(log, SignalKind::kMv, k, nullptr);
  CHECK(log.problem().empty());
  CHECK_FALSE(recall(folder.file("file") + "/samples").lines.empty());
}

TEST_CASE("a folder that cannot be read is told") {
  const test::TemporaryFolder folder;
  test::write_file(folder.file("samples"), "a file of that name");
  SampleLog log(folder.file("samples"), "a", 64);
  const std::string why = log.recall([](const BlockView*) {});
  CHECK(why == folder.file("samples") + " cannot be read: Not a directory");
}

TEST_CASE("a file is never written to through a link") {
  const test::TemporaryFolder folder;
  const std::string place = folder.file("samples");
  fs::create_directories(place);
  SampleLog log(place, "a", 64);
  fs::create_symlink("/dev/full", place + "/samples-000000000001");
  push(log, SignalKind::kMv, 1, nullptr);
  CHECK_THAT(log.problem(), Catch::Matchers::Contains("cannot be made"));
}

}  // namespace
}  // namespace mpm::live::sample_log_test
