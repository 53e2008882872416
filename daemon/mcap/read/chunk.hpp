#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/mcap/format/definitions.hpp"
#include "daemon/mcap/read/record_stream.hpp"
#include "daemon/mcap/read/unpacker.hpp"

namespace mpm::mcap {

/// What a chunk record says before its packed records.
struct ChunkHead {
  std::uint64_t start_ns = 0;  ///< earliest log time
  std::uint64_t end_ns = 0;    ///< latest
  std::uint64_t unpacked_bytes = 0;
  std::uint32_t crc = 0;  ///< of the unpacked records; 0 = not known
  std::string_view compression;
  std::uint64_t packed_bytes = 0;
  std::size_t head_bytes = 0;  ///< of these fields
};

/// `content` may end anywhere behind these fields. Nothing where they are malformed.
[[nodiscard]] std::optional<ChunkHead> read_chunk_head(ByteView content);
/// Enough of a chunk for `read_chunk_head`.
inline constexpr std::uint64_t kChunkHeadBytes = 256;

/// A message as it lies in the file.
struct RawMessage {
  ChannelId channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  ByteView data;
};

/// Nothing where it is malformed.
[[nodiscard]] std::optional<RawMessage> read_message(ByteView content);

/// The records inside an unpacked chunk, one after the other.
class ChunkRecords {
 public:
  explicit ChunkRecords(ByteView records = {}) : records_(records) {}

  /// False at the end, or at a record that is not whole: then `whole()` is false.
  [[nodiscard]] bool next();
  [[nodiscard]] Op op() const { return op_; }
  [[nodiscard]] ByteView content() const { return content_; }
  [[nodiscard]] bool whole() const { return whole_; }
  /// Of the record, in the unpacked chunk.
  [[nodiscard]] std::size_t offset() const { return offset_; }

 private:
  ByteView records_;
  std::size_t next_ = 0, offset_ = 0;
  Op op_ = Op::kHeader;
  ByteView content_;
  bool whole_ = true;
};

/// Unpacks the chunk record `content` into `out` and checks it. Returns what is wrong, in words;
/// `out` then holds what could be had.
[[nodiscard]] std::string unpack_chunk(ByteView content, Unpacker& unpacker, Bytes& out);

}  // namespace mpm::mcap
