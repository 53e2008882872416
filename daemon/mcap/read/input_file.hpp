#pragma once

#include <cstdint>
#include <string>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// A file on disk, looked at piece by piece.
class InputFile {
 public:
  /// Throws config::InputError where `path` is no file that can be read.
  explicit InputFile(const std::string& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< bytes, when it was opened
  /// `length` bytes from `offset`, valid until the next call. Fails where the file is shorter.
  [[nodiscard]] ByteView view(std::uint64_t offset, std::uint64_t length);
  /// Throws config::InputError: `FILE: error: byte OFFSET: what`.
  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

 private:
  std::string name_;
  int descriptor_;
  std::uint64_t size_ = 0;
  Bytes buffer_;
  std::uint64_t buffer_offset_ = 0;
};

}  // namespace mpm::mcap
