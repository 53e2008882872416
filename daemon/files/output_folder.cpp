#include "daemon/files/output_folder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "config/failure_text.hpp"
#include "config/finding.hpp"

namespace mpm::files {
namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path) : path_(fs::absolute(path)) {
  const auto fail = [&](const std::string& message) {
    throw config::InputError({path, 0, 0, config::Severity::kError, "", message});
  };
  std::error_code ignored;
  fs::path parent = path_;
  while (!fs::exists(parent, ignored) && parent.has_relative_path()) parent = parent.parent_path();
  if (!fs::is_directory(parent, ignored))
    fail(parent == path_ ? "is a file; --out takes a folder" : parent.string() + " is no folder");
  if (access(parent.c_str(), W_OK | X_OK) != 0)
    fail("cannot be written to: " + config::failure_text(errno));
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  files_.clear();
  for (std::size_t k = made_.size(); k-- > 0;)  // the innermost first
    fs::remove(made_[k], ignored);              // fails, as it should, on one that is not empty
}

void OutputFolder::make() {
  std::vector<fs::path> wanted;
  for (fs::path folder = path_; !fs::exists(folder); folder = folder.parent_path())
    wanted.push_back(folder);
  std::reverse(wanted.begin(), wanted.end());
  for (const fs::path& folder : wanted)
    if (fs::create_directory(folder)) made_.push_back(folder);
}

void OutputFolder::write(const std::string& name, const std::string& text) {
  make();
  files_.emplace_back((path_ / name).string()).write(text);
}

void OutputFolder::commit() {
  for (config::ReplacementFile& file : files_) file.commit();
  files_.clear();
  made_.clear();
}

}  // namespace mpm::files
