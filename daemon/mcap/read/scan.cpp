#include "daemon/mcap/read/scan.hpp"

#include <algorithm>

#include "core/text/number_text.hpp"
#include "daemon/mcap/format/crc32.hpp"
#include "daemon/mcap/format/decode.hpp"

namespace mpm::mcap {
namespace {

constexpr std::size_t kLongestName = 32;

std::uint32_t crc_of(InputFile& file, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kPiece = 64U << 10U;
  Crc32 crc;
  for (std::uint64_t at = begin; at < end; at += kPiece)
    crc.add(file.view(at, std::min(kPiece, end - at)));
  return crc.value();
}

}  // namespace

FileLayout scan(InputFile& file) {
  FileLayout layout;
  RecordStream records(file);
  bool in_data = true;
  const auto damaged = [&](const RecordHead& head, std::string what) {
    layout.damage = Damage{head.offset, std::move(what)};
  };
  while (!layout.damage) {
    const std::optional<RecordHead> head = records.next();
    if (!head) {
      layout.damage = records.damage();
      break;
    }
    if (head->op == Op::kDataEnd) in_data = false;
    if (head->op == Op::kStatistics) {
      Decoder fields(file.view(head->content(), std::min(head->length, sizeof(std::uint64_t))));
      const std::uint64_t messages = fields.u64();
      if (fields.ok()) layout.messages = messages;
    }
    if (!in_data) continue;
    if (head->op == Op::kMessage) layout.messages_outside = true;
    if (head->op == Op::kSchema || head->op == Op::kChannel) {
      const ByteView content = records.content(*head);
      std::string problem = head->op == Op::kSchema ? layout.definitions.add_schema(content)
                                                    : layout.definitions.add_channel(content);
      if (!problem.empty()) damaged(*head, std::move(problem));
    }
    if (head->op == Op::kChunk) {
      const std::optional<ChunkHead> chunk = read_chunk_head(
          file.view(head->content(), std::min<std::uint64_t>(head->length, kChunkHeadBytes)));
      if (!chunk) {
        damaged(*head, "a malformed chunk");
        continue;
      }
      layout.chunks.push_back({head->offset, chunk->start_ns, chunk->end_ns});
      layout.compressions.emplace(chunk->compression.substr(0, kLongestName));
      layout.packed_bytes += chunk->packed_bytes;
      layout.unpacked_bytes += chunk->unpacked_bytes;
    }
  }
  return layout;
}

std::string index_problem(InputFile& file, const FileLayout& layout, std::uint64_t messages) {
  constexpr std::uint64_t kFooterRecord = kRecordHead + kFooterBytes;
  const std::uint64_t footer = file.size() - kMagic.size() - kFooterRecord;
  Decoder decode(file.view(footer + kRecordHead, kFooterBytes));
  const std::uint64_t summary = decode.u64();
  decode.u64();  // of the offsets
  const std::uint32_t crc = decode.u32();
  if (summary == 0) return "the file has none";
  if (summary < kMagic.size() || summary > footer) return "the footer points outside of the file";
  if (crc != 0 && crc != crc_of(file, summary, footer + kFooterRecord - sizeof crc))
    return "it is damaged: its CRC is not right";

  std::vector<std::uint64_t> chunks;
  std::optional<std::uint64_t> counted;
  for (std::uint64_t at = summary; at < footer;) {
    Decoder head(file.view(at, std::min<std::uint64_t>(kRecordHead, footer - at)));
    const Op op{head.u8()};
    const std::uint64_t length = head.u64();
    if (!head.ok() || length > footer - at - kRecordHead) return "a record of it is cut off";
    if (op == Op::kChunkIndex || op == Op::kStatistics) {
      Decoder fields(file.view(at + kRecordHead, std::min<std::uint64_t>(length, kChunkHeadBytes)));
      const std::uint64_t first = fields.u64();
      if (op == Op::kStatistics) counted = first;
      fields.u64();
      if (op == Op::kChunkIndex) chunks.push_back(fields.u64());
      if (!fields.ok()) return "a record of it is malformed";
    }
    at += kRecordHead + length;
  }
  std::sort(chunks.begin(), chunks.end());
  if (chunks.size() != layout.chunks.size() ||
      !std::equal(
          chunks.begin(), chunks.end(), layout.chunks.begin(),
          [](std::uint64_t offset, const ChunkPlace& chunk) { return offset == chunk.offset; }))
    return "it names " + mpm::counted(chunks.size(), "chunk") + ", not the " +
           std::to_string(layout.chunks.size()) + " that are there";
  if (counted && *counted != messages)
    return "it counts " + mpm::counted(*counted, "message") + ", not the " +
           std::to_string(messages) + " that are there";
  return {};
}

}  // namespace mpm::mcap
