#include "daemon/history/alarm_store.hpp"

#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>

#include "tests/system/process.hpp"

namespace mpm::history::alarm_store_test {
namespace {

AlarmEntry entry(std::int64_t second, const std::string& what, const std::string& cv = "y1") {
  AlarmEntry entry;
  entry.written_ns = second * 1'000'000'000;
  entry.source_time_ns = entry.written_ns - 5;
  entry.unit = "shell";
  entry.mv = cv.empty() ? "" : "u1";
  entry.cv = cv;
  entry.what = what;
  entry.standing.annunciation = Annunciation::kAcknowledged;
  entry.standing.shelving = Shelving::kTimed;
  entry.standing.unshelve_time_ns = 77;
  entry.standing.out_of_service = true;
  entry.standing.user = "bob";
  entry.notification_class = NotificationClass::kAlarm;
  entry.priority = AlarmPriority::kHigh;
  entry.user = "ann";
  entry.comment = "it's \"known\"\n; DROP TABLE event";
  entry.message = std::string("a\0b", 3);
  return entry;
}

struct Journal {
  test::TemporaryFolder folder;
  std::string path = folder.file("alarms.sqlite");

  [[nodiscard]] AlarmStore open(AlarmStore::Access access = AlarmStore::Access::kAppend,
                                std::int64_t most = AlarmStore::kMostEntries) const {
    return AlarmStore(path, access, most);
  }
  /// As somebody with the file in his hands would.
  void tamper(const std::string& sql) const {
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(path.c_str(), &database) == SQLITE_OK);
    const int code = sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr);
    sqlite3_close(database);
    REQUIRE(code == SQLITE_OK);
  }
};

std::vector<std::string> whats(const AlarmStore& store, const AlarmQuery& query = {}) {
  std::vector<std::string> list;
  store.each(query, [&](const AlarmEntry& entry) { list.push_back(entry.what); });
  return list;
}
using List = std::vector<std::string>;

TEST_CASE("an entry comes back as it was, whatever is in its texts") {
  const Journal journal;
  const AlarmEntry written = entry(10, "active");
  journal.open().append({written});
  std::vector<AlarmEntry> read;
  journal.open(AlarmStore::Access::kRead).each({}, [&](const AlarmEntry& e) { read.push_back(e); });
  REQUIRE(read.size() == 1);
  CHECK(read[0].written_ns == written.written_ns);
  CHECK(read[0].source_time_ns == written.source_time_ns);
  CHECK(read[0].comment == written.comment);
  CHECK(read[0].message == written.message);
  CHECK(read[0].user == "ann");
  CHECK(read[0].notification_class == NotificationClass::kAlarm);
  CHECK(read[0].priority == AlarmPriority::kHigh);
  CHECK(read[0].standing.annunciation == Annunciation::kAcknowledged);
  CHECK(read[0].standing.shelving == Shelving::kTimed);
  CHECK(read[0].standing.unshelve_time_ns == 77);
  CHECK(read[0].standing.out_of_service);
  CHECK_FALSE(read[0].standing.suppressed);
  CHECK(read[0].standing.user == "bob");
}

TEST_CASE("entries are found by time, unit and channel") {
  const Journal journal;
  AlarmStore store = journal.open();
  store.append({entry(10, "active"), entry(20, "active", "y2"), entry(30, "cleared")});
  CHECK(whats(store) == List{"active", "active", "cleared"});
  AlarmQuery query;
  query.cv = "y1";
  CHECK(whats(store, query) == List{"active", "cleared"});
  query.since_ns = 20'000'000'000;
  CHECK(whats(store, query) == List{"cleared"});
  query.until_ns = 30'000'000'000;
  CHECK(whats(store, query).empty());
  query = {};
  query.unit = "other";
  CHECK(whats(store, query).empty());
}

TEST_CASE("the last entry of each alarm tells how it stands; what was refused does not") {
  const Journal journal;
  AlarmStore store = journal.open();
  store.append({entry(10, "active"), entry(11, "active", ""), entry(12, "acknowledged", ""),
                entry(13, "refused", "")});
  const std::vector<AlarmEntry> last = store.last_of_each("shell");
  REQUIRE(last.size() == 2);
  CHECK(last[0].cv == "y1");
  CHECK(last[1].what == "acknowledged");
  CHECK(store.last_of_each("other").empty());
}

TEST_CASE("what was changed or taken out afterwards shows") {
  const Journal journal;
  {
    AlarmStore store = journal.open();
    store.append({entry(10, "active"), entry(20, "cleared"), entry(30, "active")});
    const StoreCheck check = store.verify();
    CHECK(check.entries == 3);
    CHECK(check.problem.empty());
  }
  SECTION("changed") {
    journal.tamper("DROP TRIGGER no_update; UPDATE event SET comment = 'all well' WHERE id = 2");
    CHECK(journal.open().verify().problem == "entry number 2 was changed after it was written");
  }
  SECTION("taken out") {
    journal.tamper("DROP TRIGGER no_gap; DELETE FROM event WHERE id = 2");
    CHECK(journal.open().verify().problem == "entries are missing between number 1 and number 3");
  }
  SECTION("and cannot be with the file's own rules") {
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(journal.path.c_str(), &database) == SQLITE_OK);
    CHECK(sqlite3_exec(database, "UPDATE event SET comment = ''", nullptr, nullptr, nullptr) ==
          SQLITE_CONSTRAINT);
    CHECK(sqlite3_exec(database, "DELETE FROM event WHERE id = 2", nullptr, nullptr, nullptr) ==
          SQLITE_CONSTRAINT);
    sqlite3_close(database);
  }
}

TEST_CASE("the journal goes on after a restart, and its oldest entries go when it is full") {
  const Journal journal;
  for (int i = 0; i < 10; ++i)
    journal.open(AlarmStore::Access::kAppend, 4).append({entry(i, std::to_string(i))});
  const AlarmStore store = journal.open(AlarmStore::Access::kRead);
  CHECK(whats(store) == List{"6", "7", "8", "9"});
  CHECK(store.verify().problem.empty());
}

TEST_CASE("what was appended is there after a kill") {
  const Journal journal;
  (void)journal.open();  // made
  const pid_t child = ::fork();
  if (child == 0) {
    AlarmStore store = journal.open();
    for (int i = 0;; ++i) {
      store.append({entry(i, std::to_string(i))});
      if (i == 20) ::kill(::getpid(), SIGKILL);
    }
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFSIGNALED(status));
  const AlarmStore store = journal.open();
  CHECK(whats(store).size() == 21);
  CHECK(store.verify().problem.empty());
}

TEST_CASE("who may only read reads also when nobody writes any more") {
  Journal journal;
  journal.open().append({entry(1, "raised"), entry(2, "cleared")});
  // Of a group: whose, depends on who runs the test; root may write everywhere.
  for (const char* name : {"", "/alarms.sqlite"})
    REQUIRE(::chmod((journal.folder.file(".") + name).c_str(), *name == 0 ? 0555 : 0444) == 0);
  const uid_t user = ::geteuid(), nobody = 65534;
  if (user == 0) REQUIRE(::seteuid(nobody) == 0);
  StoreCheck check;
  std::string error;
  try {
    check = journal.open(AlarmStore::Access::kRead).verify();
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (user == 0) REQUIRE(::seteuid(user) == 0);
  REQUIRE(::chmod(journal.folder.file(".").c_str(), 0755) == 0);
  CHECK(error.empty());
  CHECK(check.entries == 2);
  CHECK(check.problem.empty());
}

TEST_CASE("others may not read the journal, and what is none is refused") {
  const Journal journal;
  CHECK_THROWS_WITH(journal.open(AlarmStore::Access::kRead),
                    Catch::Matchers::Contains("cannot be read"));
  (void)journal.open();
  struct stat status {};
  REQUIRE(::stat(journal.path.c_str(), &status) == 0);
  CHECK((status.st_mode & S_IRWXO) == 0);
  const std::string other = journal.folder.file("other");
  std::ofstream(other) << "no data base at all, but long enough to be looked at by somebody";
  CHECK_THROWS(AlarmStore(other, AlarmStore::Access::kAppend));
  const std::string pipe = journal.folder.file("pipe");  // is not waited for
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(AlarmStore(pipe, AlarmStore::Access::kAppend), pipe + ": is no file");
}

TEST_CASE("a file that was never a journal is known by its first bytes") {
  const Journal journal;
  CHECK_FALSE(is_foreign(journal.path));  // none is there
  const auto holds = [&](const std::string& text) {
    test::write_file(journal.path, text);
    return is_foreign(journal.path);
  };
  CHECK_FALSE(holds(""));
  CHECK(holds("unit: toy\n"));
  CHECK(holds("SQLite format 4, a novel"));
  CHECK(holds("SQLite"));
  CHECK_FALSE(is_foreign(journal.folder.file("")));
  test::write_file(journal.path, "");
  (void)journal.open();
  CHECK_FALSE(is_foreign(journal.path));
  CHECK_FALSE(holds(test::read_file(journal.path).substr(0, 16) + std::string(5000, 'x')));
}

}  // namespace
}  // namespace mpm::history::alarm_store_test
