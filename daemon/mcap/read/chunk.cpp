#include "daemon/mcap/read/chunk.hpp"

#include "daemon/mcap/format/crc32.hpp"
#include "daemon/mcap/format/decode.hpp"

namespace mpm::mcap {

std::optional<ChunkHead> read_chunk_head(ByteView content) {
  Decoder decode(content);
  ChunkHead head;
  head.start_ns = decode.u64();
  head.end_ns = decode.u64();
  head.unpacked_bytes = decode.u64();
  head.crc = decode.u32();
  head.compression = decode.text();
  head.packed_bytes = decode.u64();
  if (!decode.ok()) return std::nullopt;
  head.head_bytes = content.size() - decode.rest().size();
  return head;
}

std::optional<RawMessage> read_message(ByteView content) {
  Decoder decode(content);
  RawMessage message;
  message.channel = decode.u16();
  message.sequence = decode.u32();
  message.log_time_ns = decode.u64();
  message.publish_time_ns = decode.u64();
  message.data = decode.rest();
  if (!decode.ok()) return std::nullopt;
  return message;
}

bool ChunkRecords::next() {
  Decoder decode(records_.subspan(next_));
  if (decode.rest().empty()) return false;
  offset_ = next_;
  op_ = Op{decode.u8()};
  content_ = decode.bytes(decode.u64());
  whole_ = decode.ok() && op_ != Op{};
  next_ = records_.size() - decode.rest().size();
  return whole_;
}

std::string unpack_chunk(ByteView content, Unpacker& unpacker, Bytes& out) {
  out.clear();
  const std::optional<ChunkHead> head = read_chunk_head(content);
  if (!head) return "a malformed chunk";
  const ByteView rest = content.subspan(head->head_bytes);
  const ByteView packed = rest.first(std::min<std::uint64_t>(head->packed_bytes, rest.size()));
  std::string problem = unpacker.unpack(head->compression, packed, head->unpacked_bytes, out);
  if (!problem.empty()) return "a chunk " + problem;
  if (packed.size() != head->packed_bytes) return "a chunk is cut off";
  if (head->crc != 0 && head->crc != crc32(out)) return "a chunk is damaged: its CRC is not right";
  return {};
}

}  // namespace mpm::mcap
