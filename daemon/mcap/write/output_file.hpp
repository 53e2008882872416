#pragma once

#include <cstdint>
#include <string>

#include "daemon/mcap/format/crc32.hpp"

namespace mpm::mcap {

/// A file that only grows, and knows its length and the CRC of what was written since a mark.
class OutputFile {
 public:
  /// Makes or empties `path`. Throws std::runtime_error where it cannot, as do all the others.
  explicit OutputFile(const std::string& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// All of `bytes` or, where the disk is full, none of them: the file keeps its last whole write.
  void write(ByteView bytes);
  void close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  void begin_crc() { crc_ = {}; }
  [[nodiscard]] std::uint32_t crc() const { return crc_.value(); }

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
  Crc32 crc_;
};

/// Bytes that are written once and read back once. What is beyond the first few go to a file beside
/// `path` that has no name, so they cost no memory and go away with the process.
class SpillFile {
 public:
  explicit SpillFile(std::string path) : path_(std::move(path)) {}
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;
  ~SpillFile();

  /// Throws std::runtime_error where it cannot.
  void add(ByteView bytes);
  [[nodiscard]] std::uint64_t size() const { return spilled_ + buffer_.size(); }
  void copy_to(OutputFile& out);

 private:
  void spill();
  [[noreturn]] void fail() const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t spilled_ = 0;
  Bytes buffer_;
};

}  // namespace mpm::mcap
