#include "daemon/mcap/read/ordered_reader.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "daemon/mcap/format/decode.hpp"
#include "daemon/mcap/read/reader.hpp"

namespace mpm::mcap {
namespace {

// Beyond this the chunks of a file overlap for no good reason.
constexpr std::uint64_t kMostOpenBytes = 2 * kMostBytes;

void refuse_damage(const InputFile& file, const FileLayout& layout) {
  if (layout.damage)
    file.fail(layout.damage->offset, layout.damage->what + "; `mpm recover` mends what is cut off");
}

bool described(const Definitions& definitions, ChannelId id) {
  const Channel* channel = definitions.channel(id);
  return channel != nullptr &&
         (channel->schema_id == 0 || definitions.schema(channel->schema_id) != nullptr);
}

bool by_time(const ChunkPlace& a, const ChunkPlace& b) {
  return std::tie(a.start_ns, a.offset) < std::tie(b.start_ns, b.offset);
}

}  // namespace

bool OrderedReader::Later::operator()(const Entry& a, const Entry& b) const {
  return std::tie(a.log_time_ns, a.chunk_offset, a.begin) >
         std::tie(b.log_time_ns, b.chunk_offset, b.begin);
}

OrderedReader::OrderedReader(const std::string& path, const TimeRange& range)
    : file_(path), range_(range), layout_(scan(file_)) {
  refuse_damage(file_, layout_);
  if (layout_.messages_outside)
    file_.fail(0, "has messages outside of chunks, which have no order in time");
  const auto outside = [&](const ChunkPlace& chunk) {
    return std::cmp_less(chunk.end_ns, range.start_ns) ||
           std::cmp_greater_equal(chunk.start_ns, range.end_ns);
  };
  auto& chunks = layout_.chunks;
  std::erase_if(chunks, outside);
  std::sort(chunks.begin(), chunks.end(), by_time);
}

// What a channel is may stand in a chunk that is not read, or comes later.
void OrderedReader::gather_definitions() {
  gathered_ = true;
  Reader reader(file_.name());
  Message message;
  while (reader.next(message)) {
  }
  layout_.definitions = reader.definitions();
}

void OrderedReader::open_next_chunk() {
  const ChunkPlace& place = layout_.chunks[next_chunk_++];
  if (spent_.empty()) spent_.emplace_back();
  open_.splice(open_.end(), spent_, spent_.begin());
  const auto chunk = std::prev(open_.end());
  chunk->offset = place.offset;
  chunk->left = 0;

  Decoder head(file_.view(place.offset, kRecordHead));
  head.u8();
  const std::uint64_t length = head.u64();
  if (length > kMostBytes)
    file_.fail(place.offset, "a chunk of " + std::to_string(length) + " bytes");
  const std::string problem =
      unpack_chunk(file_.view(place.offset + kRecordHead, length), unpacker_, chunk->records);
  if (!problem.empty()) file_.fail(place.offset, problem);
  open_bytes_ += chunk->records.size();
  if (open_bytes_ > kMostOpenBytes)
    file_.fail(place.offset, "too many chunks overlap in time to be read in order");

  ChunkRecords records(chunk->records);
  while (records.next()) {
    std::string trouble;
    if (records.op() == Op::kSchema) trouble = layout_.definitions.add_schema(records.content());
    if (records.op() == Op::kChannel) trouble = layout_.definitions.add_channel(records.content());
    if (records.op() == Op::kMessage) {
      const std::optional<RawMessage> raw = read_message(records.content());
      if (!raw) file_.fail(place.offset, "a malformed message");
      if (raw->log_time_ns < place.start_ns || raw->log_time_ns > place.end_ns)
        file_.fail(place.offset, "a chunk holds a message of a time that it does not span");
      queue_.push({raw->log_time_ns, place.offset,
                   static_cast<std::size_t>(records.content().data() - chunk->records.data()),
                   records.content().size(), chunk});
      ++chunk->left;
    }
    if (!trouble.empty()) file_.fail(place.offset, trouble);
  }
  if (!records.whole()) file_.fail(place.offset, "a record inside a chunk is malformed");
  if (chunk->left == 0) {
    open_bytes_ -= chunk->records.size();
    open_.erase(chunk);
  }
}

bool OrderedReader::next(Message& message) {
  while (true) {
    while (next_chunk_ < layout_.chunks.size() &&
           (queue_.empty() || layout_.chunks[next_chunk_].start_ns <= queue_.top().log_time_ns))
      open_next_chunk();
    if (queue_.empty()) return false;
    const Entry entry = queue_.top();
    queue_.pop();
    const std::optional<RawMessage> raw =
        read_message(ByteView(entry.chunk->records).subspan(entry.begin, entry.length));
    if (--entry.chunk->left == 0) {  // its bytes stay until the next chunk is opened
      open_bytes_ -= entry.chunk->records.size();
      spent_.clear();
      spent_.splice(spent_.begin(), open_, entry.chunk);
    }
    if (!gathered_ && !described(layout_.definitions, raw->channel)) gather_definitions();
    std::string problem;
    const bool taken = resolve(*raw, layout_.definitions, range_, message, problem);
    if (!problem.empty()) file_.fail(entry.chunk_offset, problem);
    if (taken) return true;
  }
}

std::unique_ptr<MessageSource> open_messages(const std::string& path, const TimeRange& range) {
  InputFile file(path);
  const FileLayout layout = scan(file);
  refuse_damage(file, layout);
  if (layout.messages_outside) return std::make_unique<Reader>(path, range);
  return std::make_unique<OrderedReader>(path, range);
}

}  // namespace mpm::mcap
