#include "daemon/host/lock_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "config/failure_text.hpp"
#include "core/text/printable.hpp"

namespace mpm::host {
namespace {

constexpr std::size_t kLongestHolder = 300;
constexpr std::chrono::milliseconds kPause{50};
constexpr int kTries = 60;  // three seconds
// For who may look into the folder to see who it is.
constexpr mode_t kMode = 0640;

std::string self() {
  std::array<char, HOST_NAME_MAX + 1> host{};
  gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(getpid()) + " on host " + host.data();
}

std::string holder(int descriptor) {
  std::array<char, kLongestHolder> text{};
  const ssize_t count = pread(descriptor, text.data(), text.size(), 0);
  const std::string said(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return said.empty() ? "another process"
                      : printable(said.substr(0, said.find('\n')), kLongestHolder);
}

}  // namespace

LockFile::LockFile(const std::string& path)
    : path_(path),
      // No link: it would be somebody else's file that is written to.
      descriptor_(
          open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, kMode)) {
  if (descriptor_ < 0) {
    problem_ = path + ": " + config::failure_text(errno);
    return;
  }
  // One that was told to stop may still be about it.
  int failed = flock(descriptor_, LOCK_EX | LOCK_NB);
  for (int tries = 0; failed != 0 && errno == EWOULDBLOCK && tries < kTries; ++tries) {
    std::this_thread::sleep_for(kPause);
    failed = flock(descriptor_, LOCK_EX | LOCK_NB);
  }
  if (failed != 0) {
    const int error = errno;
    const std::string who = holder(descriptor_);
    close(std::exchange(descriptor_, -1));
    if (error == EWOULDBLOCK)
      throw std::runtime_error(path + ": is held by " + who + "; each needs a place of its own");
    problem_ = path + ": " + config::failure_text(error);
    return;
  }
  // What is said of the holder is for people; the lock holds without it.
  const std::string me = self() + "\n";
  if (ftruncate(descriptor_, 0) == 0)
    static_cast<void>(pwrite(descriptor_, me.data(), me.size(), 0) > 0);
}

LockFile::LockFile(LockFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      problem_(std::move(other.problem_)) {}

LockFile& LockFile::operator=(LockFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(problem_, other.problem_);
  return *this;
}

bool LockFile::in_place() const {
  if (descriptor_ < 0) return true;
  struct stat held {};
  struct stat there {};
  return fstat(descriptor_, &held) == 0 && stat(path_.c_str(), &there) == 0 &&
         held.st_dev == there.st_dev && held.st_ino == there.st_ino;
}

LockFile::~LockFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace mpm::host
