#include "config/replacement_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <stdexcept>

#include "config/finding.hpp"

namespace mpm::config {
namespace fs = std::filesystem;
namespace {

constexpr int kUsualMode = 0666;  // less what the process masks

/// The way to the name of a file that has none.
std::string by_descriptor(int file) { return "/proc/self/fd/" + std::to_string(file); }

/// A file in `folder` without a name, which is gone with the process that holds it, however it
/// ends; below 0 where the file system has none, or where nobody could name it later.
int open_without_name(const fs::path& folder) {
  const int made = open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, kUsualMode);
  if (made < 0 || access(by_descriptor(made).c_str(), F_OK) == 0) return made;
  close(made);
  return -1;
}

std::string unforeseen_ending() {
  std::random_device device;
  std::array<char, 20> text{};
  std::snprintf(text.data(), text.size(), ".%08x%08x", device(), device());
  return text.data();
}

}  // namespace

ReplacementFile::ReplacementFile(const std::string& path)
    : path_(fs::absolute(path)), stream_(&buffer_) {
  const auto refuse = [&](const std::string& message) {
    throw InputError({path, 0, 0, Severity::kError, "", message});
  };
  std::error_code ignored;
  const fs::path folder = path_.parent_path();
  if (!path_.has_filename() || fs::is_directory(path_, ignored)) refuse("is a folder, not a file");
  const fs::file_status there = fs::symlink_status(path_, ignored);
  if (fs::exists(there) && !fs::is_regular_file(there))
    refuse("is a link, a device or a pipe, which a file would replace; give the name of a file");
  if (!fs::is_directory(folder, ignored)) refuse("there is no folder " + folder.string());
  temporary_ = folder / ("." + path_.filename().string() + unforeseen_ending());
  int made = open_without_name(folder);
  named_ = made < 0;
  if (named_) made = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUsualMode);
  if (made < 0) refuse(std::string("cannot be written to: ") + std::strerror(errno));
  buffer_ = __gnu_cxx::stdio_filebuf<char>(made, std::ios::out | std::ios::binary);
}

ReplacementFile::~ReplacementFile() {
  std::error_code ignored;
  if (named_) fs::remove(temporary_, ignored);
}

void ReplacementFile::write(const std::string& text) {
  stream_ << text << std::flush;
  if (!stream_) fail();
}

std::uint64_t ReplacementFile::bytes() {
  struct stat there {};
  if (!stream_.flush() || fstat(descriptor(), &there) != 0) fail();
  return static_cast<std::uint64_t>(there.st_size);
}

void ReplacementFile::commit() {
  if (!stream_.flush() || fsync(descriptor()) != 0) fail();
  if (!named_ && linkat(AT_FDCWD, by_descriptor(descriptor()).c_str(), AT_FDCWD, temporary_.c_str(),
                        AT_SYMLINK_FOLLOW) != 0)
    fail();
  named_ = true;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  named_ = false;
  const int folder = open(path_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // one that may be written to and not read: the name comes in its time
  static_cast<void>(fsync(folder));
  close(folder);
}

void ReplacementFile::fail() const {
  throw std::runtime_error(path_.string() + ": cannot be written to: " + std::strerror(errno));
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& output) {
  for (const std::string& input : inputs)
    if (same_file(input, output))
      throw InputError({output, 0, 0, Severity::kError, "", "is the file that is read"});
}

void refuse_one_place(const std::string& output, const std::string& other) {
  std::error_code ignored;
  if (output.empty() || other.empty() || fs::is_other(output, ignored)) return;
  if (same_file(output, other) ||
      fs::weakly_canonical(output, ignored) == fs::weakly_canonical(other, ignored))
    throw InputError({other, 0, 0, Severity::kError, "", "is given for two outputs"});
}

}  // namespace mpm::config
