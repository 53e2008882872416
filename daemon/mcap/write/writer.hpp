#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/mcap/format/format.hpp"
#include "daemon/mcap/write/compression.hpp"
#include "daemon/mcap/write/output_file.hpp"

namespace mpm::mcap {

struct WriterOptions {
  Compression compression = Compression::kZstd;
  std::size_t chunk_bytes = 1U << 20U;        ///< a chunk closes when its messages reach this size
  std::int64_t chunk_age_ns = 1'000'000'000;  ///< or when it spans this much log time
  std::string profile;                        ///< of the header; may be empty
  std::string library = "mpm";                ///< who wrote the file
  bool must_be_new = false;                   ///< refuse a file, or a link, that is there already
};

/// Writes an MCAP file from start to end. Needs memory for one chunk, whatever the length of the
/// file. Every chunk is in the operating system's hands when it closes, so a process that is killed
/// loses at most the open one; `mpm recover` makes the rest a whole file again.
///
/// Schemas and channels stand in the data section before the chunks that use them, and once more in
/// the summary. All CRCs are written. The same calls give the same bytes.
///
/// Throws std::runtime_error where the file cannot be written (the disk is full, say): it then ends
/// behind the last whole record. Its summary has a place on the disk before anything that it tells
/// of is written, so after `drop_chunk()` the file can be finished all the same.
class Writer {
 public:
  /// Makes or empties the file; leaves none where nothing fits into it.
  explicit Writer(const OutputPlace& place, WriterOptions options = {});

  /// Ids count from 1; at most 65535 of each, std::length_error beyond.
  [[nodiscard]] SchemaId add_schema(std::string_view name, std::string_view encoding,
                                    std::string_view data);
  /// `schema` 0: the messages say themselves what they are.
  [[nodiscard]] ChannelId add_channel(SchemaId schema, std::string_view topic,
                                      std::string_view message_encoding,
                                      const TextMap& metadata = {});

  /// One message; times in ns since 1970. Log time: when it was received; publish time: when its
  /// source sent it. Without `sequence` they are counted per channel, from 0. std::length_error
  /// for more than `kMostBytes` bytes, std::invalid_argument for a time before 1970 or a channel
  /// that was not added.
  void write(ChannelId channel, std::int64_t log_time_ns, std::int64_t publish_time_ns,
             ByteView data, std::optional<std::uint32_t> sequence = {});

  /// Something about the file as a whole.
  void add_metadata(std::string_view name, const TextMap& values);

  /// Closes the open chunk if there is one; its messages are then in the file.
  void close_chunk();
  /// The same if its first message is older than the age that chunks may reach. For a caller with a
  /// clock, when no message comes that would close it.
  void close_old_chunk(std::int64_t now_ns);

  /// Forgets the open chunk, for which there is no place any more.
  void drop_chunk();

  /// Writes the summary and closes the file. A file without it is whole for sequential readers
  /// only.
  void finish();

  /// In the file so far; the open chunk comes on top.
  [[nodiscard]] std::uint64_t bytes_written() const { return file_.size(); }
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t chunks() const { return chunks_; }
  /// True while there is an open chunk: its messages are not in the file yet.
  [[nodiscard]] bool has_open_chunk() const { return !chunk_.empty(); }

 private:
  struct ChannelState {
    std::uint64_t messages = 0;
    std::uint32_t sequence = 0;
    Bytes index;  ///< of the open chunk: log time and offset of each message
  };

  void write_record(std::uint64_t reserve);
  void forget_chunk();
  /// Writes a definition, which comes once more in the summary.
  void write_definition(Bytes& in_summary);
  /// What comes behind the data as they are.
  [[nodiscard]] std::uint64_t ending_bytes() const;
  void write_summary_group(Op op, ByteView records, Bytes& offsets);
  void write_offset(Op op, std::uint64_t start, Bytes& offsets) const;
  void encode_statistics(Bytes& out) const;

  OutputFile file_;
  WriterOptions options_;
  Compressor compressor_;
  Bytes record_;  // scratch

  Bytes chunk_;
  std::uint64_t chunk_first_ns_ = 0;  // of its first message; the next two are its extremes
  std::uint64_t chunk_start_ns_ = 0;
  std::uint64_t chunk_end_ns_ = 0;

  std::map<ChannelId, ChannelState> channels_;
  SchemaId schemas_ = 0;
  Bytes schema_records_, channel_records_, metadata_indexes_;
  SpillFile chunk_indexes_;
  std::uint64_t messages_ = 0, chunks_ = 0, metadata_ = 0;
  std::uint64_t start_ns_ = 0, end_ns_ = 0;  // of the closed chunks
};

}  // namespace mpm::mcap
