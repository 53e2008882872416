#include "daemon/mcap/scan.hpp"

#include <algorithm>

namespace mpm::mcap {

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
      if (chunk)
        layout.chunks.push_back({head->offset, chunk->start_ns, chunk->end_ns});
      else
        damaged(*head, "a malformed chunk");
    }
  }
  return layout;
}

}  // namespace mpm::mcap
