#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <queue>
#include <string>
#include <vector>

#include "daemon/mcap/format/message.hpp"
#include "daemon/mcap/read/scan.hpp"

namespace mpm::mcap {

/// Reads the messages of a chunked file in the order of their log times; those of the same time in
/// the order of the file. Chunks may overlap and lie in any order; those outside the range are not
/// unpacked. Needs memory for the chunks that overlap at one moment, and 24 bytes for each chunk of
/// the file.
class OrderedReader : public MessageSource {
 public:
  /// Throws config::InputError where the file is no MCAP file, is torn, or has messages outside of
  /// chunks (`open_messages` reads those too).
  explicit OrderedReader(const std::string& path, const TimeRange& range = {});

  [[nodiscard]] bool next(Message& message) override;
  [[nodiscard]] const Definitions& definitions() const override { return layout_.definitions; }

 private:
  struct OpenChunk {
    Bytes records;
    std::size_t left = 0;  // messages not yet read
    std::uint64_t offset = 0;
  };
  struct Entry {
    std::uint64_t log_time_ns = 0;
    std::uint64_t chunk_offset = 0;
    std::size_t begin = 0;  // of the message's content in the chunk
    std::size_t length = 0;
    std::list<OpenChunk>::iterator chunk;
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const;
  };

  void gather_definitions();
  void open_next_chunk();

  InputFile file_;
  TimeRange range_;
  FileLayout layout_;
  bool gathered_ = false;
  Unpacker unpacker_;
  std::size_t next_chunk_ = 0;
  std::list<OpenChunk> open_;
  std::uint64_t open_bytes_ = 0;
  std::list<OpenChunk> spent_;  // the last one read from, whose memory is used again
  std::priority_queue<Entry, std::vector<Entry>, Later> queue_;
};

/// The messages of any MCAP file: in time order if they lie in chunks, else in the order of the
/// file. Throws config::InputError where the file is none, or is torn.
[[nodiscard]] std::unique_ptr<MessageSource> open_messages(const std::string& path,
                                                           const TimeRange& range = {});

}  // namespace mpm::mcap
