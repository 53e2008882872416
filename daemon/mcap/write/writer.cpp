#include "daemon/mcap/write/writer.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include "daemon/mcap/format/encode.hpp"

namespace mpm::mcap {
namespace {

constexpr std::uint64_t kMessageFields = 22;  // bytes before a message's data
constexpr std::size_t kIndexEntry = 16;       // bytes of a message in its channel's index

// Of the ending, in bytes: what has always the same length, and what each channel adds.
constexpr std::uint64_t kDataEnd = kRecordHead + 4;
constexpr std::uint64_t kStatistics = kRecordHead + 46, kStatisticsEntry = 10;
constexpr std::uint64_t kSummaryOffsets = 5 * (kRecordHead + 17);
constexpr std::uint64_t kFooter = kRecordHead + kFooterBytes + kMagic.size();

std::uint64_t unsigned_time(std::int64_t time_ns) {
  if (time_ns < 0) throw std::invalid_argument("MCAP: a time before 1970 cannot be recorded");
  return static_cast<std::uint64_t>(time_ns);
}

std::uint16_t next_id(std::size_t so_far, const char* what) {
  if (so_far >= std::numeric_limits<std::uint16_t>::max())
    throw std::length_error(std::string("MCAP: more than 65535 ") + what);
  return static_cast<std::uint16_t>(so_far + 1);
}

}  // namespace

Writer::Writer(const OutputPlace& place, WriterOptions options)
    : file_(place, options.must_be_new ? OutputFile::Opening::kMakeNew
                                       : OutputFile::Opening::kMakeOrEmpty),
      options_(std::move(options)),
      compressor_(options_.compression),
      chunk_indexes_(place.path) {
  Encoder encode(record_);
  encode.bytes(kMagic);
  encode.record(Op::kHeader, [&] {
    encode.text(options_.profile);
    encode.text(options_.library);
  });
  try {
    write_record(ending_bytes());
  } catch (const std::runtime_error&) {
    if (options_.must_be_new) static_cast<void>(std::remove(place.path.c_str()));
    throw;
  }
}

void Writer::write_record(std::uint64_t reserve) {
  try {
    file_.write(record_, reserve);
  } catch (const std::runtime_error&) {
    record_.clear();
    throw;
  }
  record_.clear();
}

void Writer::write_definition(Bytes& in_summary) {
  const Bytes record = record_;
  write_record(ending_bytes() + record.size());
  in_summary.insert(in_summary.end(), record.begin(), record.end());
}

std::uint64_t Writer::ending_bytes() const {
  return kDataEnd + schema_records_.size() + channel_records_.size() + chunk_indexes_.size() +
         metadata_indexes_.size() + kStatistics + kStatisticsEntry * (channels_.size() + 1) +
         kSummaryOffsets + kFooter;
}

SchemaId Writer::add_schema(std::string_view name, std::string_view encoding,
                            std::string_view data) {
  const SchemaId id = next_id(schemas_, "schemas");
  Encoder encode(record_);
  encode.record(Op::kSchema, [&] {
    encode.u16(id);
    encode.text(name);
    encode.text(encoding);
    encode.text(data);
  });
  write_definition(schema_records_);
  schemas_ = id;
  return id;
}

ChannelId Writer::add_channel(SchemaId schema, std::string_view topic,
                              std::string_view message_encoding, const TextMap& metadata) {
  if (schema > schemas_) throw std::invalid_argument("MCAP: a channel of an unknown schema");
  const ChannelId id = next_id(channels_.size(), "channels");
  Encoder encode(record_);
  encode.record(Op::kChannel, [&] {
    encode.u16(id);
    encode.u16(schema);
    encode.text(topic);
    encode.text(message_encoding);
    encode.map(metadata);
  });
  write_definition(channel_records_);
  channels_[id];
  return id;
}

void Writer::write(ChannelId channel, std::int64_t log_time_ns, std::int64_t publish_time_ns,
                   ByteView data, std::optional<std::uint32_t> sequence) {
  const auto found = channels_.find(channel);
  if (found == channels_.end()) throw std::invalid_argument("MCAP: a message of no channel");
  if (data.size() > kMostBytes - kMessageFields)
    throw std::length_error("MCAP: a message of " + std::to_string(data.size()) + " bytes");
  const std::uint64_t log_ns = unsigned_time(log_time_ns);
  const std::uint64_t publish_ns = unsigned_time(publish_time_ns);

  const std::uint64_t size = kRecordHead + kMessageFields + data.size();
  if (!chunk_.empty() && chunk_.size() + size > std::max(kMostBytes, size)) close_chunk();
  close_old_chunk(log_time_ns);
  if (chunk_.empty()) chunk_first_ns_ = chunk_start_ns_ = chunk_end_ns_ = log_ns;
  chunk_start_ns_ = std::min(chunk_start_ns_, log_ns);
  chunk_end_ns_ = std::max(chunk_end_ns_, log_ns);

  ChannelState& state = found->second;
  Encoder index(state.index);
  index.u64(log_ns);
  index.u64(chunk_.size());
  if (sequence) state.sequence = *sequence;
  Encoder encode(chunk_);
  encode.record(Op::kMessage, [&] {
    encode.u16(channel);
    encode.u32(state.sequence++);
    encode.u64(log_ns);
    encode.u64(publish_ns);
    encode.bytes(data);
  });

  ++state.messages;
  ++messages_;
  if (chunk_.size() >= options_.chunk_bytes) close_chunk();
}

void Writer::close_old_chunk(std::int64_t now_ns) {
  if (chunk_.empty()) return;
  const auto age_ns = now_ns - static_cast<std::int64_t>(chunk_first_ns_);
  if (age_ns >= options_.chunk_age_ns) close_chunk();
}

// The chunk and its message indexes are one write, so that a full disk leaves both or none.
void Writer::close_chunk() {
  if (chunk_.empty()) return;
  const ByteView packed = compressor_.pack(chunk_);
  const std::string_view compression = name_of(options_.compression);
  const std::uint64_t chunk_offset = file_.size();
  Encoder encode(record_);
  encode.record(Op::kChunk, [&] {
    encode.u64(chunk_start_ns_);
    encode.u64(chunk_end_ns_);
    encode.u64(chunk_.size());
    encode.u32(crc32(chunk_));
    encode.text(compression);
    encode.u64(packed.size());
    encode.bytes(packed);
  });
  const std::uint64_t chunk_length = record_.size();

  Bytes offsets;
  Encoder encode_offsets(offsets);
  for (const auto& [id, state] : channels_) {
    if (state.index.empty()) continue;
    encode_offsets.u16(id);
    encode_offsets.u64(chunk_offset + record_.size());
    encode.record(Op::kMessageIndex, [&, channel = id, &index = state.index] {
      encode.u16(channel);
      encode.u32(static_cast<std::uint32_t>(index.size()));
      encode.bytes(index);
    });
  }
  const std::uint64_t index_length = record_.size() - chunk_length;

  Bytes chunk_index;
  Encoder encode_index(chunk_index);
  encode_index.record(Op::kChunkIndex, [&] {
    encode_index.u64(chunk_start_ns_);
    encode_index.u64(chunk_end_ns_);
    encode_index.u64(chunk_offset);
    encode_index.u64(chunk_length);
    encode_index.u32(static_cast<std::uint32_t>(offsets.size()));
    encode_index.bytes(offsets);
    encode_index.u64(index_length);
    encode_index.text(compression);
    encode_index.u64(packed.size());
    encode_index.u64(chunk_.size());
  });
  write_record(ending_bytes() + chunk_index.size());
  chunk_indexes_.add(chunk_index);
  start_ns_ = chunks_ == 0 ? chunk_start_ns_ : std::min(start_ns_, chunk_start_ns_);
  end_ns_ = std::max(end_ns_, chunk_end_ns_);
  ++chunks_;
  forget_chunk();
}

void Writer::forget_chunk() {
  chunk_.clear();
  for (auto& [id, state] : channels_) state.index.clear();
}

void Writer::drop_chunk() {
  for (auto& [id, state] : channels_) {
    state.messages -= state.index.size() / kIndexEntry;
    messages_ -= state.index.size() / kIndexEntry;
  }
  forget_chunk();
}

void Writer::add_metadata(std::string_view name, const TextMap& values) {
  const std::uint64_t offset = file_.size();
  Encoder encode(record_);
  encode.record(Op::kMetadata, [&] {
    encode.text(name);
    encode.map(values);
  });
  Bytes index_record;
  Encoder index(index_record);
  index.record(Op::kMetadataIndex, [&] {
    index.u64(offset);
    index.u64(record_.size());
    index.text(name);
  });
  write_record(ending_bytes() + index_record.size());
  metadata_indexes_.insert(metadata_indexes_.end(), index_record.begin(), index_record.end());
  ++metadata_;
}

void Writer::write_offset(Op op, std::uint64_t start, Bytes& offsets) const {
  Encoder encode(offsets);
  encode.record(Op::kSummaryOffset, [&] {
    encode.u8(static_cast<std::uint8_t>(op));
    encode.u64(start);
    encode.u64(file_.size() - start);
  });
}

void Writer::write_summary_group(Op op, ByteView records, Bytes& offsets) {
  if (records.empty()) return;
  const std::uint64_t start = file_.size();
  file_.write(records);
  write_offset(op, start, offsets);
}

void Writer::encode_statistics(Bytes& out) const {
  Encoder encode(out);
  encode.record(Op::kStatistics, [&] {
    encode.u64(messages_);
    encode.u16(schemas_);
    encode.u32(static_cast<std::uint32_t>(channels_.size()));
    encode.u32(0);  // attachments
    encode.u32(static_cast<std::uint32_t>(metadata_));
    encode.u32(static_cast<std::uint32_t>(chunks_));
    encode.u64(start_ns_);
    encode.u64(end_ns_);
    constexpr std::size_t kEntry = sizeof(ChannelId) + sizeof(std::uint64_t);
    encode.u32(static_cast<std::uint32_t>(kEntry * channels_.size()));
    for (const auto& [id, state] : channels_) {
      encode.u16(id);
      encode.u64(state.messages);
    }
  });
}

void Writer::finish() {
  close_chunk();
  const std::uint32_t data_crc = file_.crc();
  Encoder encode(record_);
  encode.record(Op::kDataEnd, [&] { encode.u32(data_crc); });
  write_record(0);

  file_.begin_crc();
  const std::uint64_t summary_start = file_.size();
  Bytes offsets;
  write_summary_group(Op::kSchema, schema_records_, offsets);
  write_summary_group(Op::kChannel, channel_records_, offsets);
  if (chunks_ > 0) {
    const std::uint64_t start = file_.size();
    chunk_indexes_.copy_to(file_);
    write_offset(Op::kChunkIndex, start, offsets);
  }
  write_summary_group(Op::kMetadataIndex, metadata_indexes_, offsets);
  Bytes statistics;
  encode_statistics(statistics);
  write_summary_group(Op::kStatistics, statistics, offsets);
  const std::uint64_t offset_start = file_.size();
  file_.write(offsets);

  // The summary's CRC goes up to the footer's own CRC field, so the footer comes in two pieces.
  encode.u8(static_cast<std::uint8_t>(Op::kFooter));
  encode.u64(kFooterBytes);
  encode.u64(summary_start);
  encode.u64(offset_start);
  write_record(0);
  encode.u32(file_.crc());
  encode.bytes(kMagic);
  write_record(0);
  file_.close();
}

}  // namespace mpm::mcap
