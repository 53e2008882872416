#include "daemon/live/report_store.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <regex>
#include <system_error>
#include <vector>

#include "daemon/files/folder_name.hpp"
#include "daemon/report/report_files.hpp"

namespace mpm::live {
namespace {

namespace fs = std::filesystem;

/// By when they were written: a replay's alarms may be older than all of them.
void prune(const fs::path& unit, const fs::path& newest, std::size_t kept) {
  static const std::regex ours("[0-9]{8,}T[0-9]{6}([.][0-9]{3})?Z");
  std::vector<std::pair<fs::file_time_type, fs::path>> others;
  for (const fs::directory_entry& entry : fs::directory_iterator(unit))
    if (entry.is_directory() && entry.path() != newest &&
        std::regex_match(entry.path().filename().string(), ours))
      others.emplace_back(entry.last_write_time(), entry.path());
  if (others.size() < kept) return;
  std::sort(others.begin(), others.end());
  const std::size_t too_many = others.size() + 1 - kept;
  for (std::size_t i = 0; i < too_many; ++i) fs::remove_all(others[i].second);
}

}  // namespace

ReportStore::ReportStore(std::string folder, std::size_t kept)
    : folder_(std::move(folder)), kept_(kept) {}

std::string ReportStore::problem() const {
  if (folder_.empty()) return {};
  std::error_code error;
  fs::create_directories(folder_, error);
  if (!error && access(folder_.c_str(), W_OK | X_OK) != 0)
    error.assign(errno, std::generic_category());
  return error ? folder_ + ": " + error.message() : "";
}

std::string ReportStore::write(const report::DiagnosisRun& run, std::int64_t alarm_time_ns) const {
  if (folder_.empty()) return {};
  const fs::path unit = fs::path(folder_) / files::folder_name(run.unit.unit);
  const fs::path place = unit / files::time_folder(alarm_time_ns);
  files::OutputFolder folder(place.string());
  report::write_reports(run, folder);
  folder.commit();
  fs::last_write_time(place, fs::file_time_type::clock::now());  // renaming within may not tell
  prune(unit, place, kept_);
  return place.string();
}

}  // namespace mpm::live
