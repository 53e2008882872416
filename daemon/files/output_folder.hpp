#pragma once

#include <filesystem>
#include <list>
#include <string>
#include <vector>

#include "config/replacement_file.hpp"

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

  /// Writes `text` for the file `name`. Throws as ReplacementFile does.
  void write(const std::string& name, const std::string& text);
  void commit();

 private:
  void make();

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  ///< folders, outermost first
  std::list<config::ReplacementFile> files_;
};

}  // namespace mpm::files
