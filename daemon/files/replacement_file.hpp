#pragma once

#include <filesystem>
#include <string>

namespace mpm::files {

/// A file that appears when it is whole, or not at all: written under a temporary name beside its
/// place and renamed by commit(). An older file of that name stays until then.
class ReplacementFile {
 public:
  /// Touches nothing yet. Throws config::InputError where no such file can be made.
  explicit ReplacementFile(const std::string& path);
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;
  ~ReplacementFile();

  /// Where to write.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::string temporary_;
};

/// True where both are names of one file that exists.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

}  // namespace mpm::files
