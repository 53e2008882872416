#include "daemon/history/read_journal.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "config/finding.hpp"
#include "core/text/printable.hpp"
#include "daemon/files/csv/csv_line.hpp"
#include "daemon/history/digest_json.hpp"
#include "daemon/history/journal_files.hpp"

namespace mpm::history {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Lines that say nothing of a trend begin so, and need not be parsed.
constexpr std::string_view kChannel = R"({"record":"channel")", kHealth = R"({"record":"health")";

[[noreturn]] void fail(const std::string& path, const std::string& message, int line = 0,
                       int column = 0) {
  throw config::InputError({path, line, column, config::Severity::kError, "", message});
}

Json parse(const std::string& path, int line, const std::string& text) {
  try {
    Json json = Json::parse(text);
    if (json.is_object() && !json.value("record", std::string()).empty()) return json;
  } catch (const Json::parse_error& error) {
    fail(path, "is no JSON", line, static_cast<int>(error.byte));
  } catch (const Json::exception&) {
  }
  fail(path, "is no line of a journal", line, 1);
}

UnitHead head_at(const std::string& path, int line, const Json& json) {
  UnitHead head;
  try {
    head = head_of(json);
  } catch (const Json::exception&) {
    fail(path, "is no head of a journal", line, 1);
  }
  if (head.format != UnitHead::kFormat)
    fail(path,
         "is a journal of format " + std::to_string(head.format) + ", and " +
             std::to_string(UnitHead::kFormat) + " is known",
         line, 1);
  return head;
}

/// Nothing where the file is empty, or was cut before its first line ended.
std::optional<UnitHead> first_head(const std::string& path) {
  files::LineReader lines(files::open_regular_file(path), path);
  if (!lines.next() || !lines.complete()) return std::nullopt;
  const Json json = parse(path, lines.number(), lines.text());
  if (json["record"] != "journal")
    fail(path,
         "does not begin as a journal does (with --journal-every-sample none is written that a "
         "trend could be made of)",
         1, 1);
  return head_at(path, 1, json);
}

std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
      std::string unit;
      int number = 0;
      if (parse_journal_name(entry.path().filename().string(), unit, number))
        files.push_back(entry.path().string());
    }
    if (files.size() == before) fail(path, "no journal in this folder");
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> journal_of(const std::vector<std::string>& paths,
                                    const std::string& unit) {
  std::vector<std::pair<std::int64_t, std::string>> found;
  std::set<std::string> units;
  for (const std::string& file : files_of(paths)) {
    const std::optional<UnitHead> head = first_head(file);
    if (!head) continue;
    units.insert(head->unit);
    if (unit.empty() || head->unit == unit) found.emplace_back(head->time_ns, file);
  }
  std::string names;
  for (const std::string& name : units)
    names += (names.empty() ? "'" : ", '") + printable(name) + "'";
  if (units.empty()) fail(paths.front(), "nothing stands in this journal");
  if (found.empty())
    fail(paths.front(), "no journal of unit '" + printable(unit) + "' but of " + names);
  if (unit.empty() && units.size() > 1)
    fail(paths.front(), "holds journals of several units: say with --unit which of " + names);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> files;
  files.reserve(found.size());
  for (auto& [time_ns, file] : found) files.push_back(std::move(file));
  return files;
}

void read_journal(const std::string& path, const JournalReader& reader) {
  files::LineReader lines(files::open_regular_file(path), path);
  while (lines.next() && lines.complete()) {
    const std::string& text = lines.text();
    const int line = lines.number();
    if (text.starts_with(kChannel) || text.starts_with(kHealth)) continue;
    const Json json = parse(path, line, text);
    const std::string record = json["record"];
    try {
      if (record == "journal") reader.head(head_at(path, line, json));
      if (record == "digest") reader.digest(digest_of(json));
      if (record == "alarm")
        reader.alarm({json.at("mv"), json.at("cv"), json.at("to") == "active", json.at("time_ns")});
    } catch (const Json::exception&) {
      fail(path, "is no " + printable(record) + " of a journal", line, 1);
    }
  }
}

}  // namespace mpm::history
