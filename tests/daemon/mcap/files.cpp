#include "tests/daemon/mcap/files.hpp"

#include <lz4frame.h>

#include "daemon/mcap/format/crc32.hpp"
#include "daemon/mcap/write/compression.hpp"
#include "tests/system/process.hpp"

namespace mpm::test {

using mcap::Encoder;
using mcap::Op;

std::vector<Kept> read_all(mcap::MessageSource& source) {
  std::vector<Kept> all;
  mcap::Message message;
  while (source.next(message))
    all.push_back(
        {message.channel->topic, message.schema == nullptr ? "" : message.schema->name,
         std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()),
         message.log_time_ns, message.publish_time_ns, message.sequence});
  return all;
}

mcap::ByteView bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

HandMade::HandMade() {
  Encoder encode(bytes_);
  encode.bytes(mcap::kMagic);
  encode.record(Op::kHeader, [&] {
    encode.text("");
    encode.text("by hand");
    encode.u32(7);  // a field that a later version may add
  });
}

void HandMade::schema(mcap::SchemaId id, std::string_view name) {
  Encoder encode(bytes_);
  encode.record(Op::kSchema, [&] {
    encode.u16(id);
    encode.text(name);
    encode.text("jsonschema");
    encode.text("{}");
  });
}

void HandMade::channel(mcap::ChannelId id, mcap::SchemaId schema, std::string_view topic) {
  Encoder encode(bytes_);
  encode.record(Op::kChannel, [&] {
    encode.u16(id);
    encode.u16(schema);
    encode.text(topic);
    encode.text("json");
    encode.map({});
  });
}

void HandMade::message(mcap::ChannelId channel, std::uint64_t time_ns, std::string_view data) {
  Encoder encode(bytes_);
  encode.record(Op::kMessage, [&] {
    encode.u16(channel);
    encode.u32(0);
    encode.u64(time_ns);
    encode.u64(time_ns);
    encode.bytes(bytes_of(data));
  });
}

void HandMade::begin_chunk() { outside_.swap(bytes_); }

void HandMade::end_chunk(std::string_view compression, std::uint64_t start_ns, std::uint64_t end_ns,
                         bool with_crc) {
  outside_.swap(bytes_);
  const mcap::Bytes records = std::move(outside_);
  outside_.clear();
  mcap::Bytes packed = records;
  if (compression == "zstd") {
    mcap::Compressor zstd(mcap::Compression::kZstd);
    const mcap::ByteView view = zstd.pack(records);
    packed.assign(view.begin(), view.end());
  } else if (compression == "lz4") {
    packed.resize(LZ4F_compressFrameBound(records.size(), nullptr));
    packed.resize(
        LZ4F_compressFrame(packed.data(), packed.size(), records.data(), records.size(), nullptr));
  }
  Encoder encode(bytes_);
  encode.record(Op::kChunk, [&] {
    encode.u64(start_ns);
    encode.u64(end_ns);
    encode.u64(records.size());
    encode.u32(with_crc ? mcap::crc32(records) : 0);
    encode.text(compression);
    encode.u64(packed.size());
    encode.bytes(packed);
  });
}

void HandMade::record(Op op, std::string_view content) {
  Encoder encode(bytes_);
  encode.record(op, [&] { encode.bytes(bytes_of(content)); });
}

void HandMade::end() {
  Encoder encode(bytes_);
  encode.record(Op::kDataEnd, [&] { encode.u32(0); });
  encode.record(Op::kFooter, [&] {
    encode.u64(0);
    encode.u64(0);
    encode.u32(0);
  });
  encode.bytes(mcap::kMagic);
}

void HandMade::save(const std::string& path) const {
  write_file(path, std::string(reinterpret_cast<const char*>(bytes_.data()), bytes_.size()));
}

}  // namespace mpm::test
