// Loaded before a program (LD_PRELOAD): what of the folder MPM_POWER_FOLDER would be on the disk if
// the power went now is kept in MPM_POWER_DISK, on the same file system:
//   synced/INODE  what a file held when it was last synced
//   names/INODE   of a folder, when that was last synced: a line "INODE NAME" for each entry
//   held/INODE    the file itself, so that no number is used twice
// Nothing else is on the disk for certain: not what was written since, nor names that were made,
// changed or removed since. tests/system/disk_image makes disks of it.

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>

namespace {

namespace fs = std::filesystem;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

std::string path_of(int descriptor) {
  std::array<char, 4096> text{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = readlink(link.c_str(), text.data(), text.size());
  return size <= 0 ? "" : std::string(text.data(), static_cast<std::size_t>(size));
}

bool watched(const std::string& path) {
  static const std::string folder = variable("MPM_POWER_FOLDER");
  return !folder.empty() && path.starts_with(folder);
}

std::string kept(const char* what, ino_t inode) {
  static const std::string disk = variable("MPM_POWER_DISK");
  return disk + "/" + what + "/" + std::to_string(inode);
}

void replace(const std::string& from, const std::string& to) {
  std::rename(from.c_str(), to.c_str());
}

std::string fresh() {
  static int number = 0;
  return kept("synced", 0) + "-" + std::to_string(getpid()) + "-" + std::to_string(++number);
}

void hold(const std::string& path, ino_t inode) {
  linkat(AT_FDCWD, path.c_str(), AT_FDCWD, kept("held", inode).c_str(), AT_SYMLINK_FOLLOW);
}

void keep_file(const std::string& path, ino_t inode) {
  const std::string copy = fresh();
  std::error_code failed;
  fs::copy_file(path, copy, failed);
  if (!failed) replace(copy, kept("synced", inode));
}

void keep_names(const std::string& folder, ino_t inode) {
  const std::string list = fresh();
  {
    std::ofstream names(list);
    DIR* entries = opendir(folder.c_str());
    while (const dirent* entry = entries == nullptr ? nullptr : readdir(entries)) {
      const std::string name = entry->d_name;
      if (name != "." && name != "..") names << entry->d_ino << ' ' << name << '\n';
    }
    if (entries != nullptr) closedir(entries);
  }
  replace(list, kept("names", inode));
}

std::mutex& lock() {
  static std::mutex mutex;
  return mutex;
}

void sync(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return;
  if (S_ISDIR(status.st_mode)) return keep_names(path, status.st_ino);
  if (!S_ISREG(status.st_mode)) return;
  hold(path, status.st_ino);
  keep_file(path, status.st_ino);
}

int sync(int descriptor) {
  const std::string path = path_of(descriptor);
  const std::lock_guard<std::mutex> guard(lock());
  // By the descriptor: the file may have another name by now, or none.
  if (watched(path)) {
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
      sync("/proc/self/fd/" + std::to_string(descriptor));
    else
      sync(path);
  }
  return 0;
}

int hold_made(int descriptor, int flags) {
  if (descriptor < 0 || (flags & O_CREAT) == 0 || !watched(path_of(descriptor))) return descriptor;
  const int error = errno;
  struct stat status {};
  if (fstat(descriptor, &status) == 0)
    hold("/proc/self/fd/" + std::to_string(descriptor), status.st_ino);
  errno = error;
  return descriptor;
}

mode_t mode_of(int flags, va_list& more) {
  return (flags & (O_CREAT | O_TMPFILE)) == 0 ? 0 : static_cast<mode_t>(va_arg(more, int));
}

/// All that is there now.
void sync_all() {
  const std::string folder = variable("MPM_POWER_FOLDER");
  std::error_code failed;
  sync(folder);
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    sync(entry->path().string());
}

// What the program finds has been on the disk for long.
[[gnu::constructor]] void begin() {
  const std::lock_guard<std::mutex> guard(lock());
  sync_all();
}

}  // namespace

extern "C" int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  static auto* real = next<int(const char*, int, ...)>("open");
  return hold_made(real(path, flags, mode), flags);
}

extern "C" int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  static auto* real = next<int(const char*, int, ...)>("open64");
  return hold_made(real(path, flags, mode), flags);
}

extern "C" int fsync(int descriptor) { return sync(descriptor); }
extern "C" int fdatasync(int descriptor) { return sync(descriptor); }

extern "C" int syncfs(int /*descriptor*/) noexcept {
  const std::lock_guard<std::mutex> guard(lock());
  sync_all();
  return 0;
}
