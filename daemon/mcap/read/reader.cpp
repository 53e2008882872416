#include "daemon/mcap/read/reader.hpp"

#include <algorithm>

#include "daemon/mcap/format/decode.hpp"

namespace mpm::mcap {

bool resolve(const RawMessage& raw, const Definitions& definitions, const TimeRange& range,
             Message& message, std::string& problem) {
  constexpr auto kLatest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (raw.log_time_ns > kLatest || raw.publish_time_ns > kLatest) {
    problem = "a message of a time beyond the year 2262";
    return false;
  }
  message.log_time_ns = static_cast<std::int64_t>(raw.log_time_ns);
  if (message.log_time_ns < range.start_ns || message.log_time_ns >= range.end_ns) return false;
  message.channel = definitions.channel(raw.channel);
  if (message.channel == nullptr) {
    problem = "a message of channel " + std::to_string(raw.channel) + ", which nothing describes";
    return false;
  }
  message.schema = definitions.schema(message.channel->schema_id);
  if (message.schema == nullptr && message.channel->schema_id != 0) {
    problem = "channel " + std::to_string(raw.channel) + " names schema " +
              std::to_string(message.channel->schema_id) + ", which is not there";
    return false;
  }
  message.sequence = raw.sequence;
  message.publish_time_ns = static_cast<std::int64_t>(raw.publish_time_ns);
  message.data = raw.data;
  return true;
}

Reader::Reader(const std::string& path, const TimeRange& range)
    : file_(path), records_(file_), range_(range) {}

bool Reader::next(Message& message) {
  while (true) {
    if (next_in_chunk(message)) return true;
    const std::optional<RecordHead> head = records_.next();
    if (!head) {
      if (const auto& damage = records_.damage())
        file_.fail(damage->offset, damage->what + "; `mpm recover` mends what is cut off");
      return false;
    }
    switch (head->op) {
      case Op::kHeader: {
        Decoder decode(records_.content(*head));
        profile_ = decode.text();
        library_ = decode.text();
        if (!decode.ok()) file_.fail(head->offset, "a malformed header");
        break;
      }
      case Op::kSchema:
      case Op::kChannel:
        add_definition(head->op, records_.content(*head), head->offset);
        break;
      case Op::kMessage:
        if (take(records_.content(*head), head->offset, message)) return true;
        break;
      case Op::kChunk:
        open_chunk(*head);
        break;
      case Op::kDataEnd:
        check_data_crc(*head);
        break;
      default:
        break;
    }
  }
}

void Reader::add_definition(Op op, ByteView content, std::uint64_t offset) {
  const std::string problem =
      op == Op::kSchema ? definitions_.add_schema(content) : definitions_.add_channel(content);
  if (!problem.empty()) file_.fail(offset, problem);
}

bool Reader::take(ByteView content, std::uint64_t offset, Message& message) const {
  const std::optional<RawMessage> raw = read_message(content);
  if (!raw) file_.fail(offset, "a malformed message");
  std::string problem;
  const bool taken = resolve(*raw, definitions_, range_, message, problem);
  if (!problem.empty()) file_.fail(offset, problem);
  return taken;
}

void Reader::open_chunk(const RecordHead& head) {
  const std::optional<ChunkHead> chunk = read_chunk_head(
      file_.view(head.content(), std::min<std::uint64_t>(head.length, kChunkHeadBytes)));
  if (!chunk) file_.fail(head.offset, "a malformed chunk");
  chunk_offset_ = head.offset;
  const std::string problem = unpack_chunk(records_.content(head), unpacker_, chunk_);
  if (!problem.empty()) file_.fail(head.offset, problem);
  in_chunk_ = ChunkRecords(chunk_);
}

bool Reader::next_in_chunk(Message& message) {
  while (in_chunk_.next()) {
    switch (in_chunk_.op()) {
      case Op::kSchema:
      case Op::kChannel:
        add_definition(in_chunk_.op(), in_chunk_.content(), chunk_offset_);
        break;
      case Op::kMessage:
        if (take(in_chunk_.content(), chunk_offset_, message)) return true;
        break;
      default:
        break;
    }
  }
  if (!in_chunk_.whole()) file_.fail(chunk_offset_, "a record inside a chunk is malformed");
  in_chunk_ = ChunkRecords();
  return false;
}

// A pass of its own at the end, piece by piece: the chunks' CRCs tell most damage before.
void Reader::check_data_crc(const RecordHead& head) {
  Decoder decode(records_.content(head));
  const std::uint32_t crc = decode.u32();
  if (!decode.ok()) file_.fail(head.offset, "a malformed end of the data");
  if (crc == 0 || !range_.everything()) return;
  constexpr std::uint64_t kPiece = 64U << 10U;
  Crc32 found;
  for (std::uint64_t at = 0; at < head.offset; at += kPiece)
    found.add(file_.view(at, std::min(kPiece, head.offset - at)));
  if (crc != found.value()) file_.fail(head.offset, "the data are damaged: their CRC is not right");
}

}  // namespace mpm::mcap
