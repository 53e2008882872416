#include "daemon/history/alarm_store.hpp"

#include <fcntl.h>
#include <openssl/sha.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/text/netstring.hpp"

namespace mpm::history {
namespace {

constexpr int kBusyMs = 2000;
constexpr const char* kVersion = "1";

// In the order of `columns_of` and `entry_of`.
constexpr const char* kColumns =
    "written_ns, time_ns, unit, mv, cv, what, alarm_state, annunciation, shelving, unshelve_ns, "
    "suppressed, suppressed_by_design, out_of_service, active_ns, ack_ns, class, priority, "
    "last_user, last_comment, user, host, comment, message";

// Entries are added, and leave at the far end alone.
constexpr const char* kSchema = R"(
CREATE TABLE IF NOT EXISTS settings(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS event(
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  written_ns INTEGER NOT NULL, time_ns INTEGER NOT NULL,
  unit TEXT NOT NULL, mv TEXT NOT NULL, cv TEXT NOT NULL,
  what TEXT NOT NULL, alarm_state TEXT NOT NULL, annunciation TEXT NOT NULL,
  shelving TEXT NOT NULL, unshelve_ns INTEGER NOT NULL,
  suppressed INTEGER NOT NULL, suppressed_by_design INTEGER NOT NULL,
  out_of_service INTEGER NOT NULL, active_ns INTEGER NOT NULL, ack_ns INTEGER NOT NULL,
  class TEXT NOT NULL, priority TEXT NOT NULL,
  last_user TEXT NOT NULL, last_comment TEXT NOT NULL,
  user TEXT NOT NULL, host TEXT NOT NULL, comment TEXT NOT NULL, message TEXT NOT NULL,
  link TEXT NOT NULL);
CREATE INDEX IF NOT EXISTS event_of_alarm ON event(unit, mv, cv, id);
CREATE INDEX IF NOT EXISTS event_by_time ON event(written_ns);
CREATE TRIGGER IF NOT EXISTS no_update BEFORE UPDATE ON event
  BEGIN SELECT RAISE(ABORT, 'entries are never changed'); END;
CREATE TRIGGER IF NOT EXISTS no_gap BEFORE DELETE ON event
  WHEN OLD.id <> (SELECT min(id) FROM event)
  BEGIN SELECT RAISE(ABORT, 'only the oldest entry may go'); END;
)";

/// The values of a row as text, from which it is written and summed.
struct Cells {
  std::array<std::string, 23> text;
};

std::string flag(bool set) { return set ? "1" : "0"; }

Cells cells_of(const AlarmEntry& entry) {
  const AlarmStanding& standing = entry.standing;
  return {{std::to_string(entry.written_ns),
           std::to_string(entry.source_time_ns),
           entry.unit,
           entry.mv,
           entry.cv,
           entry.what,
           std::string(to_string(standing.word())),
           std::string(to_string(standing.annunciation)),
           std::string(to_string(standing.shelving)),
           std::to_string(standing.unshelve_time_ns),
           flag(standing.suppressed),
           flag(standing.suppressed_by_design),
           flag(standing.out_of_service),
           std::to_string(standing.active_time_ns),
           std::to_string(standing.ack_time_ns),
           std::string(to_string(entry.notification_class)),
           std::string(to_string(entry.priority)),
           standing.user,
           standing.comment,
           entry.user,
           entry.host,
           entry.comment,
           entry.message}};
}

std::string text_at(sqlite3_stmt* row, int column) {
  const unsigned char* text = sqlite3_column_text(row, column);
  return text == nullptr ? std::string()
                         : std::string(reinterpret_cast<const char*>(text),
                                       static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

template <class Enum>
Enum word_at(sqlite3_stmt* row, int column) {
  return from_string<Enum>(text_at(row, column)).value_or(Enum{});
}

AlarmEntry entry_of(sqlite3_stmt* row) {
  AlarmEntry entry;
  entry.written_ns = sqlite3_column_int64(row, 0);
  entry.source_time_ns = sqlite3_column_int64(row, 1);
  entry.unit = text_at(row, 2);
  entry.mv = text_at(row, 3);
  entry.cv = text_at(row, 4);
  entry.what = text_at(row, 5);
  AlarmStanding& standing = entry.standing;
  standing.annunciation = word_at<Annunciation>(row, 7);
  standing.shelving = word_at<Shelving>(row, 8);
  standing.unshelve_time_ns = sqlite3_column_int64(row, 9);
  standing.suppressed = sqlite3_column_int(row, 10) != 0;
  standing.suppressed_by_design = sqlite3_column_int(row, 11) != 0;
  standing.out_of_service = sqlite3_column_int(row, 12) != 0;
  standing.active_time_ns = sqlite3_column_int64(row, 13);
  standing.ack_time_ns = sqlite3_column_int64(row, 14);
  entry.notification_class = word_at<NotificationClass>(row, 15);
  entry.priority = word_at<AlarmPriority>(row, 16);
  standing.user = text_at(row, 17);
  standing.comment = text_at(row, 18);
  entry.user = text_at(row, 19);
  entry.host = text_at(row, 20);
  entry.comment = text_at(row, 21);
  entry.message = text_at(row, 22);
  return entry;
}

/// SHA-256 over the link before and the row, as hexadecimal digits.
std::string link_of(const std::string& before, const Cells& cells) {
  std::string text;
  append_netstring(text, before);
  for (const std::string& cell : cells.text) append_netstring(text, cell);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
  std::string hex;
  for (const unsigned char byte : digest) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += kDigits[byte >> 4U];
    hex += kDigits[byte & 0xFU];
  }
  return hex;
}

Cells cells_at(sqlite3_stmt* row) {
  Cells cells;
  for (std::size_t i = 0; i < cells.text.size(); ++i)
    cells.text[i] = text_at(row, static_cast<int>(i));
  return cells;
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> file_at(const std::string& path) {
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) return std::nullopt;
  return std::pair<std::uint64_t, std::uint64_t>(there.st_dev, there.st_ino);
}

/// In words, for SQLite has one for all, and would wait for a pipe: what there is instead of a
/// file.
void check_kind(const std::string& path) {
  struct stat there {};
  if (stat(path.c_str(), &there) != 0) return;
  if (S_ISDIR(there.st_mode))
    throw std::runtime_error(path + ": is a folder; the journal is a file, as alarms.sqlite");
  if (!S_ISREG(there.st_mode)) throw std::runtime_error(path + ": is no file");
}

/// Likewise, where it may not be read.
void check_readable(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    throw std::runtime_error(path + ": cannot be read: " + std::generic_category().message(errno));
  ::close(file);
}

/// The file as SQLite is to open it. Beside one that was written ahead it makes files of its own,
/// even to read: who may not, reads it as one that nobody writes to, where that is so.
std::string as_opened(const std::string& path, AlarmStore::Access access) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).parent_path();
  std::error_code failed;
  if (access == AlarmStore::Access::kAppend || fs::exists(path + "-wal", failed) ||
      ::faccessat(AT_FDCWD, folder.empty() ? "." : folder.c_str(), W_OK, AT_EACCESS) == 0)
    return path;
  std::string uri = "file:";
  for (const char letter : path) {
    if (letter == '?')
      uri += "%3f";
    else if (letter == '#')
      uri += "%23";
    else if (letter == '%')
      uri += "%25";
    else
      uri += letter;
  }
  return uri + "?immutable=1";
}

}  // namespace

bool is_foreign(const std::string& path) {
  constexpr std::string_view kHeader("SQLite format 3\0", 16);
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return false;
  std::ifstream file(path, std::ios::binary);
  std::array<char, kHeader.size()> begin{};
  file.read(begin.data(), begin.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  return count > 0 && std::string_view(begin.data(), count) != kHeader;
}

void AlarmStore::CloseStatement::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

AlarmStore::AlarmStore(const std::string& path, Access access, std::int64_t most)
    : path_(path), most_(most) {
  check_kind(path);
  if (access == Access::kRead) check_readable(path);
  if (access == Access::kAppend)  // before anything is in it
    if (const int made =
            ::open(path.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, S_IRUSR | S_IWUSR | S_IRGRP);
        made >= 0)
      ::close(made);
  const int flags =
      access == Access::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const std::string file = as_opened(path, access);
  const int opened = sqlite3_open_v2(file.c_str(), &database_,
                                     flags | (file == path ? 0 : SQLITE_OPEN_URI), nullptr);
  try {
    if (opened != SQLITE_OK) fail("cannot be opened");
    sqlite3_busy_timeout(database_, kBusyMs);
    if (access == Access::kAppend) {
      run("PRAGMA journal_mode=WAL");
      run("PRAGMA synchronous=FULL");
      run(kSchema);
      run(std::string("INSERT OR IGNORE INTO settings VALUES('version', '") + kVersion + "')");
    }
    if (access == Access::kRead) check_is_journal();
    const Statement version = prepare("SELECT value FROM settings WHERE key = 'version'");
    if (sqlite3_step(version.get()) != SQLITE_ROW || text_at(version.get(), 0) != kVersion)
      throw std::runtime_error(path + ": is no journal of alarms of this version");
    const Statement last = prepare("SELECT link FROM event ORDER BY id DESC LIMIT 1");
    if (sqlite3_step(last.get()) == SQLITE_ROW) link_ = text_at(last.get(), 0);
    opened_ = file_at(path);
  } catch (...) {
    sqlite3_close(database_);
    throw;
  }
}

bool AlarmStore::in_place() const { return opened_ && file_at(path_) == opened_; }

AlarmStore::~AlarmStore() { sqlite3_close(database_); }

void AlarmStore::check_is_journal() const {
  sqlite3_stmt* statement = nullptr;
  const int found =
      sqlite3_prepare_v2(database_, "SELECT value FROM settings", -1, &statement, nullptr);
  sqlite3_finalize(statement);
  if (found == SQLITE_ERROR || found == SQLITE_NOTADB)  // there is no such table, or none at all
    throw std::runtime_error(path_ + ": is no journal of alarms");
  if (found == SQLITE_CANTOPEN)
    throw std::runtime_error(path_ +
                             ": cannot be read: SQLite keeps files beside it, and this user may "
                             "not write there");
}

void AlarmStore::fail(const std::string& doing) const {
  const std::string why = path_ + ": " + doing + ": " + sqlite3_errmsg(database_);
  const int code = sqlite3_errcode(database_);
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) throw DamagedStore(why);
  throw std::runtime_error(why);
}

void AlarmStore::run(const std::string& sql) const {
  if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail("cannot be written");
}

AlarmStore::Statement AlarmStore::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK)
    fail("cannot be read");
  return Statement(statement);
}

void AlarmStore::insert(sqlite3_stmt* statement, const AlarmEntry& entry) {
  const Cells cells = cells_of(entry);
  std::string link = link_of(link_, cells);
  int column = 0;
  for (const std::string& cell : cells.text)
    sqlite3_bind_text(statement, ++column, cell.data(), static_cast<int>(cell.size()),
                      SQLITE_TRANSIENT);
  sqlite3_bind_text(statement, ++column, link.data(), static_cast<int>(link.size()),
                    SQLITE_TRANSIENT);
  if (sqlite3_step(statement) != SQLITE_DONE) fail("cannot be written");
  sqlite3_reset(statement);
  link_ = std::move(link);
}

void AlarmStore::append(const std::vector<AlarmEntry>& entries) {
  const std::string before = link_;
  run("BEGIN IMMEDIATE");
  try {
    std::string marks = "?";
    for (std::size_t i = 1; i <= Cells().text.size(); ++i) marks += ", ?";
    const Statement add =
        prepare("INSERT INTO event(" + std::string(kColumns) + ", link) VALUES(" + marks + ")");
    for (const AlarmEntry& entry : entries) insert(add.get(), entry);
    const Statement trim = prepare(
        "DELETE FROM event WHERE id = (SELECT min(id) FROM event) AND "
        "id <= (SELECT max(id) FROM event) - ?");
    sqlite3_bind_int64(trim.get(), 1, most_);
    do {
      sqlite3_reset(trim.get());
      if (sqlite3_step(trim.get()) != SQLITE_DONE) fail("cannot be trimmed");
    } while (sqlite3_changes(database_) > 0);
    run("COMMIT");
  } catch (...) {
    link_ = before;
    sqlite3_exec(database_, "ROLLBACK", nullptr, nullptr, nullptr);
    throw;
  }
}

void AlarmStore::each(const AlarmQuery& query,
                      const std::function<void(const AlarmEntry&)>& visit) const {
  select(query, "id", visit);
}

std::vector<AlarmEntry> AlarmStore::youngest(const AlarmQuery& query, std::size_t most) const {
  std::vector<AlarmEntry> entries;
  select(query, "id DESC LIMIT " + std::to_string(most),
         [&](const AlarmEntry& entry) { entries.push_back(entry); });
  return entries;
}

void AlarmStore::select(const AlarmQuery& query, const std::string& order,
                        const std::function<void(const AlarmEntry&)>& visit) const {
  std::string where = "1";
  if (query.since_ns) where += " AND written_ns >= " + std::to_string(*query.since_ns);
  if (query.until_ns) where += " AND written_ns < " + std::to_string(*query.until_ns);
  std::vector<const std::string*> texts;
  const auto match = [&](const char* column, const std::string& text) {
    if (text.empty()) return;
    where += std::string(" AND ") + column + " = ?";
    texts.push_back(&text);
  };
  match("unit", query.unit);
  match("mv", query.mv);
  match("cv", query.cv);
  const Statement rows = prepare("SELECT " + std::string(kColumns) + " FROM event WHERE " + where +
                                 " ORDER BY " + order);
  for (std::size_t i = 0; i < texts.size(); ++i)
    sqlite3_bind_text(rows.get(), static_cast<int>(i) + 1, texts[i]->data(),
                      static_cast<int>(texts[i]->size()), SQLITE_TRANSIENT);
  int state = SQLITE_ROW;
  while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) visit(entry_of(rows.get()));
  if (state != SQLITE_DONE) fail("cannot be read");
}

std::vector<AlarmEntry> AlarmStore::last_of_each(const std::string& unit) const {
  const Statement rows =
      prepare("SELECT " + std::string(kColumns) +
              " FROM event WHERE id IN (SELECT max(id) FROM event WHERE unit = ? AND what <> "
              "'refused' GROUP BY mv, cv) ORDER BY id");
  sqlite3_bind_text(rows.get(), 1, unit.data(), static_cast<int>(unit.size()), SQLITE_TRANSIENT);
  std::vector<AlarmEntry> entries;
  int state = SQLITE_ROW;
  while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) entries.push_back(entry_of(rows.get()));
  if (state != SQLITE_DONE) fail("cannot be read");
  return entries;
}

StoreCheck AlarmStore::verify() const {
  StoreCheck check;
  const Statement whole = prepare("PRAGMA integrity_check(1)");
  if (sqlite3_step(whole.get()) != SQLITE_ROW || text_at(whole.get(), 0) != "ok") {
    check.problem = "the file is damaged: " + text_at(whole.get(), 0);
    return check;
  }
  const Statement rows =
      prepare("SELECT " + std::string(kColumns) + ", link, id FROM event ORDER BY id");
  const int link_column = static_cast<int>(Cells().text.size());
  std::optional<std::string> before;  // what was before the oldest entry is not known
  std::int64_t id_before = 0;
  int state = SQLITE_ROW;
  while ((state = sqlite3_step(rows.get())) == SQLITE_ROW) {
    const std::string link = text_at(rows.get(), link_column);
    const std::int64_t id = sqlite3_column_int64(rows.get(), link_column + 1);
    if (!before && id == 1) before = "";
    if (before && check.problem.empty()) {
      if (id_before != 0 && id != id_before + 1)
        check.problem = "entries are missing between number " + std::to_string(id_before) +
                        " and number " + std::to_string(id);
      else if (link_of(*before, cells_at(rows.get())) != link)
        check.problem = "entry number " + std::to_string(id) + " was changed after it was written";
    }
    before = link;
    id_before = id;
    ++check.entries;
  }
  if (state != SQLITE_DONE) fail("cannot be read");
  return check;
}

}  // namespace mpm::history
