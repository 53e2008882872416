#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace mpm::files {

/// Files that appear together or not at all: written under temporary names beside their places,
/// renamed by commit(). What was not committed goes away, the folder too if it was made for it.
class OutputFolder {
 public:
  /// Touches nothing yet. Throws config::InputError where `path` is no folder, or cannot be one.
  explicit OutputFolder(const std::string& path);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  /// Writes `text` for the file `name`. Throws std::runtime_error where it cannot.
  void write(const std::string& name, const std::string& text);
  void commit();

 private:
  void make();

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  ///< folders, outermost first
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>> files_;  ///< from, to
};

}  // namespace mpm::files
