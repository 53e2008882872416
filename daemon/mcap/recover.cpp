#include "daemon/mcap/recover.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "daemon/mcap/format/decode.hpp"
#include "daemon/mcap/read/chunk.hpp"
#include "daemon/mcap/write/writer.hpp"

namespace mpm::mcap {
namespace {

constexpr std::size_t kMostProblems = 100;  // told one by one

ChannelId channel_id(ByteView content) { return Decoder(content).u16(); }

class Recovery {
 public:
  Recovery(const std::string& input, const OutputPlace& output)
      : file_(input), records_(file_), writer_(output, options()) {}

  RecoverReport run() {
    while (true) {
      while (const std::optional<RecordHead> head = records_.next()) take(*head);
      const std::optional<Damage> damage = records_.damage();
      if (!damage) break;
      problem(damage->offset, damage->what);
      // A length that was damaged makes the rest look cut off too: look for whole chunks in it.
      if (const std::optional<std::uint64_t> next = find_chunk(damage->offset + 1)) {
        report_.lost_bytes += *next - damage->offset;
        records_.resume(*next);
        continue;
      }
      if (records_.torn() && records_.torn()->op == Op::kChunk) take_torn(*records_.torn());
      report_.lost_bytes += file_.size() - damage->offset;
      break;
    }
    writer_.finish();
    report_.whole = report_.problems.empty();
    report_.messages = writer_.messages();
    report_.channels = channels_.size();
    report_.chunks = writer_.chunks();
    return std::move(report_);
  }

 private:
  static WriterOptions options() {
    WriterOptions options;
    options.library = "mpm recover";
    options.chunk_age_ns = std::numeric_limits<std::int64_t>::max();  // as the old file had them
    return options;
  }

  /// What goes on is told once, with how often it came.
  void problem(std::uint64_t offset, const std::string& what) {
    if (what == last_problem_ && !report_.problems.empty()) {
      ++repeated_;
      report_.problems.back() = first_ + ", and " + std::to_string(repeated_) +
                                " more of the kind up to byte " + std::to_string(offset);
      return;
    }
    if (report_.problems.size() > kMostProblems) return;
    last_problem_ = what;
    repeated_ = 0;
    first_ = report_.problems.size() == kMostProblems
                 ? "and more"
                 : "byte " + std::to_string(offset) + ": " + what;
    report_.problems.push_back(first_);
  }

  void take(const RecordHead& head) {
    if (in_summary_) return;
    switch (head.op) {
      case Op::kSchema:
      case Op::kChannel:
      case Op::kMessage:
        if (head.length > kMostBytes)
          problem(head.offset, "a record of " + std::to_string(head.length) + " bytes");
        else
          take_record(head.op, records_.content(head), head.offset);
        break;
      case Op::kChunk:
        take_chunk(head);
        break;
      case Op::kMetadata:
        take_metadata(head);
        break;
      case Op::kAttachment:
        problem(head.offset, "an attachment is left out");
        break;
      case Op::kDataEnd:
        in_summary_ = true;
        break;
      default:
        break;
    }
  }

  void take_chunk(const RecordHead& head) {
    const std::string trouble = head.length > kMostBytes
                                    ? "a chunk of " + std::to_string(head.length) + " bytes"
                                    : unpack_chunk(records_.content(head), unpacker_, chunk_);
    if (!trouble.empty()) {
      problem(head.offset, trouble);
      report_.lost_bytes += kRecordHead + head.length;
      return;
    }
    if (!take_records(head.offset)) problem(head.offset, "a record inside a chunk is malformed");
    writer_.close_chunk();
  }

  void take_torn(const RecordHead& head) {
    const std::uint64_t there = std::min(file_.size() - head.content(), kMostBytes);
    // What is wrong with it is known; its first records may be right nevertheless.
    static_cast<void>(unpack_chunk(file_.view(head.content(), there), unpacker_, chunk_));
    const std::uint64_t before = writer_.messages();
    static_cast<void>(take_records(head.offset));
    report_.torn_messages = writer_.messages() - before;
    writer_.close_chunk();
  }

  bool take_records(std::uint64_t offset) {
    ChunkRecords records(chunk_);
    while (records.next()) take_record(records.op(), records.content(), offset);
    return records.whole();
  }

  void take_record(Op op, ByteView content, std::uint64_t offset) {
    std::string trouble;
    if (op == Op::kSchema) trouble = definitions_.add_schema(content);
    if (op == Op::kChannel) {
      trouble = definitions_.add_channel(content);
      if (trouble.empty())
        static_cast<void>(channel_of(*definitions_.channel(channel_id(content))));
    }
    if (op == Op::kMessage) trouble = take_message(content);
    if (!trouble.empty()) problem(offset, trouble);
  }

  std::string take_message(ByteView content) {
    constexpr auto kLatest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    const std::optional<RawMessage> raw = read_message(content);
    if (!raw) return "a malformed message";
    if (raw->log_time_ns > kLatest || raw->publish_time_ns > kLatest)
      return "a message of a time beyond the year 2262";
    const Channel* channel = definitions_.channel(raw->channel);
    if (channel == nullptr)
      return "a message of channel " + std::to_string(raw->channel) + ", which nothing describes";
    writer_.write(channel_of(*channel), static_cast<std::int64_t>(raw->log_time_ns),
                  static_cast<std::int64_t>(raw->publish_time_ns), raw->data, raw->sequence);
    return {};
  }

  ChannelId channel_of(const Channel& channel) {
    const auto known = channels_.find(channel.id);
    if (known != channels_.end()) return known->second;
    return channels_[channel.id] = writer_.add_channel(schema_of(channel.schema_id), channel.topic,
                                                       channel.message_encoding, channel.metadata);
  }

  SchemaId schema_of(SchemaId old) {
    const Schema* schema = definitions_.schema(old);
    if (schema == nullptr) return 0;
    const auto known = schemas_.find(old);
    if (known != schemas_.end()) return known->second;
    return schemas_[old] = writer_.add_schema(schema->name, schema->encoding, schema->data);
  }

  void take_metadata(const RecordHead& head) {
    if (head.length > kMostBytes) return problem(head.offset, "metadata of absurd length");
    Decoder decode(records_.content(head));
    const std::string name(decode.text());
    const TextMap values = decode.map();
    if (decode.ok())
      writer_.add_metadata(name, values);
    else
      problem(head.offset, "malformed metadata");
  }

  /// The first chunk from `offset` on that proves to be one by its CRC or its packing.
  std::optional<std::uint64_t> find_chunk(std::uint64_t offset) {
    for (; offset + kRecordHead < file_.size(); ++offset) {
      const std::uint64_t there =
          std::min<std::uint64_t>(file_.size() - offset, kRecordHead + kChunkHeadBytes);
      Decoder decode(file_.view(offset, there));
      if (Op{decode.u8()} != Op::kChunk) continue;
      const std::uint64_t length = decode.u64();
      if (length > kMostBytes || length > file_.size() - offset - kRecordHead) continue;
      const std::optional<ChunkHead> head = read_chunk_head(
          decode.rest().first(std::min<std::uint64_t>(decode.rest().size(), length)));
      if (!head || head->head_bytes + head->packed_bytes != length) continue;
      if (head->compression.empty() && head->crc == 0) continue;  // nothing would prove it
      if (unpack_chunk(file_.view(offset + kRecordHead, length), unpacker_, chunk_).empty())
        return offset;
    }
    return std::nullopt;
  }

  InputFile file_;
  RecordStream records_;
  Writer writer_;
  Definitions definitions_;
  Unpacker unpacker_;
  Bytes chunk_;
  std::map<SchemaId, SchemaId> schemas_;     // old to new
  std::map<ChannelId, ChannelId> channels_;  // old to new
  bool in_summary_ = false;
  RecoverReport report_;
  std::string first_, last_problem_;  // as told, and without its place
  std::uint64_t repeated_ = 0;
};

}  // namespace

RecoverReport recover(const std::string& input, const OutputPlace& output) {
  return Recovery(input, output).run();
}

}  // namespace mpm::mcap
