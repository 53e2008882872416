#pragma once

#include <string>

namespace mpm::host {

/// A file that one process holds as long as this lives, and beside which it alone may write: of two
/// the second one is refused. The system lets go of it however the process ends; the file stays.
class LockFile {
 public:
  /// Throws std::runtime_error, which says who holds it, where another one does.
  explicit LockFile(const std::string& path);
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&& other) noexcept;
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;
  ~LockFile();

  /// False where the file was removed, so that another process would make and hold one of its own.
  /// True where none is held.
  [[nodiscard]] bool in_place() const;
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Why it is not held although nobody else holds it: it cannot be made there, as on a full disk.
  /// That is no reason not to watch a plant. Empty where it is held.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::string problem_;
};

}  // namespace mpm::host
