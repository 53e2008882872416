#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "daemon/mcap/format/crc32.hpp"

namespace mpm::mcap {

/// Where to write: a file by its name or, with a descriptor, one that somebody made, empty, and
/// keeps open. Nothing is opened by name then, and `path` is only told.
struct OutputPlace {
  OutputPlace(std::string its_path, int its_descriptor = -1)
      : path(std::move(its_path)), descriptor(its_descriptor) {}
  std::string path;
  int descriptor;
};

/// A file that only grows, and knows its length and the CRC of what was written since a mark.
class OutputFile {
 public:
  enum class Opening { kMakeOrEmpty, kMakeNew };  ///< the latter follows no link

  /// Throws std::runtime_error where it cannot, as do all the others.
  OutputFile(const OutputPlace& place, Opening opening);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// All of `bytes` or, where the disk is full, none of them: the file keeps its last whole write.
  /// `reserve`: bytes that are sure to fit behind them, as far as the file system can promise that.
  /// What is reserved is used by the next write.
  void write(ByteView bytes, std::uint64_t reserve = 0);
  /// Gives back what is reserved and was not used.
  void close();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  void begin_crc() { crc_ = {}; }
  [[nodiscard]] std::uint32_t crc() const { return crc_.value(); }

 private:
  /// False with errno where the disk is full.
  [[nodiscard]] bool make_room(std::uint64_t bytes);
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  int descriptor_;
  std::uint64_t most_bytes_;    // that this process may write into one file
  std::uint64_t reserved_ = 0;  // bytes of the file that have their place on the disk
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

  /// On a full disk they stay in memory.
  void add(ByteView bytes);
  [[nodiscard]] std::uint64_t size() const { return spilled_ + buffer_.size(); }
  /// Throws std::runtime_error where it cannot.
  void copy_to(OutputFile& out);

 private:
  /// False where the disk is full.
  [[nodiscard]] bool spill();
  [[noreturn]] void fail() const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t spilled_ = 0;
  Bytes buffer_;
};

}  // namespace mpm::mcap
