#pragma once

#include <ext/stdio_filebuf.h>

#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace mpm::config {

/// A file that appears when it is whole, or not at all: written without a name, or where the file
/// system cannot under a temporary one beside its place, and given its name by commit(). An older
/// file of that name stays until then. What is there and is no regular file (a device, a pipe, a
/// link to either) is never replaced.
class ReplacementFile {
 public:
  /// Makes the file; a temporary name is one that nobody can foresee and that was not there: what
  /// others put in its folder is never written to. Throws config::InputError where it cannot.
  explicit ReplacementFile(const std::string& path);
  ReplacementFile(const ReplacementFile&) = delete;
  ReplacementFile& operator=(const ReplacementFile&) = delete;
  ~ReplacementFile();

  /// Where to write, all the time the file that was made: whoever may write to its folder can give
  /// the temporary name to another one.
  [[nodiscard]] std::ostream& stream() { return stream_; }
  /// The same, for what writes by itself. Stays this object's.
  [[nodiscard]] int descriptor() { return buffer_.fd(); }
  /// The temporary name, which it may have, to be told.
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  /// Throws std::runtime_error where it cannot.
  void write(const std::string& text);
  /// Of the file so far. Throws as write() does.
  [[nodiscard]] std::uint64_t bytes();
  /// It is on the disk before it has its name, so that no power cut leaves half of it. Throws
  /// std::runtime_error where it cannot.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::string temporary_;
  bool named_ = false;  ///< there is a file of the temporary name
  __gnu_cxx::stdio_filebuf<char> buffer_;
  std::ostream stream_;
};

/// True where both are names of one file that exists.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);
/// Throws config::InputError where a file written as `output` would take the place of one of
/// `inputs`, which are read.
void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& output);

/// Throws config::InputError where both outputs would be one file, in which the second one written
/// takes the first one's place. Devices, pipes and empty names are none.
void refuse_one_place(const std::string& output, const std::string& other);

}  // namespace mpm::config
