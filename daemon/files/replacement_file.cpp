#include "daemon/files/replacement_file.hpp"

#include <unistd.h>

#include "config/finding.hpp"

namespace mpm::files {
namespace fs = std::filesystem;

ReplacementFile::ReplacementFile(const std::string& path) : path_(fs::absolute(path)) {
  const auto fail = [&](const std::string& message) {
    throw config::InputError({path, 0, 0, config::Severity::kError, "", message});
  };
  std::error_code ignored;
  const fs::path folder = path_.parent_path();
  if (!path_.has_filename() || fs::is_directory(path_, ignored)) fail("is a folder, not a file");
  if (!fs::is_directory(folder, ignored)) fail("there is no folder " + folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail("cannot be written to");
  temporary_ = folder / ("." + path_.filename().string() + "." + std::to_string(getpid()));
}

ReplacementFile::~ReplacementFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void ReplacementFile::commit() { fs::rename(temporary_, path_); }

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

}  // namespace mpm::files
