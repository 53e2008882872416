#pragma once

#include <optional>
#include <string>

#include "daemon/mcap/read/input_file.hpp"

namespace mpm::mcap {

/// Where a record lies in its file.
struct RecordHead {
  Op op = Op::kHeader;
  std::uint64_t offset = 0;  ///< of its opcode
  std::uint64_t length = 0;  ///< of its content

  [[nodiscard]] std::uint64_t content() const { return offset + kRecordHead; }
  [[nodiscard]] std::uint64_t end() const { return content() + length; }
};

/// Why a file cannot be read on.
struct Damage {
  std::uint64_t offset = 0;
  std::string what;
};

/// Walks over the records of a file without looking into them, up to the footer and what has to
/// follow it.
class RecordStream {
 public:
  /// Fails where the file does not begin as MCAP files do.
  explicit RecordStream(InputFile& file);

  /// The next whole record; nothing at the end or where the file is damaged.
  [[nodiscard]] std::optional<RecordHead> next();

  [[nodiscard]] const std::optional<Damage>& damage() const { return damage_; }
  /// The record whose end is not there, if that is the damage.
  [[nodiscard]] const std::optional<RecordHead>& torn() const { return torn_; }
  /// Goes on at `offset` after a damage.
  void resume(std::uint64_t offset);
  /// Content of a record that must be in memory as a whole; fails on one that is too long for that.
  [[nodiscard]] ByteView content(const RecordHead& head);

 private:
  std::optional<RecordHead> stop(std::uint64_t offset, std::string what);

  InputFile& file_;
  std::uint64_t next_ = kMagic.size();
  bool done_ = false;
  std::optional<Damage> damage_;
  std::optional<RecordHead> torn_;
};

/// True if the file begins like an MCAP file. False also where it cannot be read.
[[nodiscard]] bool is_mcap(const std::string& path);

}  // namespace mpm::mcap
