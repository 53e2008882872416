#include "daemon/http/kept_reports.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <system_error>

#include "config/whole_file.hpp"
#include "daemon/files/folder_name.hpp"

namespace mpm::http {
namespace {

namespace fs = std::filesystem;

/// As files::time_folder names them: no part of it leads anywhere else.
bool is_name(const std::string& name) {
  static const std::regex ours("[0-9]{8,}T[0-9]{6}([.][0-9]{3})?Z");
  return std::regex_match(name, ours);
}

}  // namespace

std::vector<std::string> KeptReports::names(const std::string& unit) const {
  std::vector<std::string> found;
  if (folder_.empty()) return found;
  std::error_code error;
  for (fs::directory_iterator entry(fs::path(folder_) / files::folder_name(unit), error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code none;
    if (is_name(name) && fs::exists(entry->path() / "report.html", none)) found.push_back(name);
  }
  std::sort(found.rbegin(), found.rend());
  return found;
}

std::optional<std::string> KeptReports::read(const std::string& unit, const std::string& name,
                                             const std::string& file) const {
  if (folder_.empty() || !is_name(name) || (file != "report.html" && file != "report.json"))
    return std::nullopt;
  const fs::path path = fs::path(folder_) / files::folder_name(unit) / name / file;
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  if (error || bytes > kMostBytes) return std::nullopt;
  std::string why;
  return config::read_whole_file(path.string(), why);
}

}  // namespace mpm::http
