#pragma once

#include <optional>
#include <string>

#include "daemon/mcap/format/crc32.hpp"
#include "daemon/mcap/format/message.hpp"
#include "daemon/mcap/read/chunk.hpp"

namespace mpm::mcap {

/// Reads the messages of an MCAP file in the order in which they lie there, chunked or not, with an
/// index or without. Needs memory for one chunk. Checks the CRC of every chunk and, if all of the
/// file is read, of the data section.
///
/// A file that is torn gives its messages and then fails; what it says names the byte and, where
/// the end is missing, `mpm recover`.
class Reader : public MessageSource {
 public:
  /// Throws config::InputError where the file is no MCAP file.
  explicit Reader(const std::string& path, const TimeRange& range = {});

  [[nodiscard]] bool next(Message& message) override;
  [[nodiscard]] const Definitions& definitions() const override { return definitions_; }
  [[nodiscard]] const std::string& profile() const { return profile_; }
  [[nodiscard]] const std::string& library() const { return library_; }

 private:
  [[nodiscard]] bool next_in_chunk(Message& message);
  [[nodiscard]] bool take(ByteView content, std::uint64_t offset, Message& message) const;
  void add_definition(Op op, ByteView content, std::uint64_t offset);
  void open_chunk(const RecordHead& head);
  void check_data_crc(const RecordHead& head);

  InputFile file_;
  RecordStream records_;
  TimeRange range_;
  Definitions definitions_;
  Unpacker unpacker_;
  std::string profile_, library_;
  Bytes chunk_;
  ChunkRecords in_chunk_;
  std::uint64_t chunk_offset_ = 0;
};

/// Turns a raw message into one with its channel. False: it lies outside `range`. Returns what is
/// wrong in `problem`.
[[nodiscard]] bool resolve(const RawMessage& raw, const Definitions& definitions,
                           const TimeRange& range, Message& message, std::string& problem);

}  // namespace mpm::mcap
