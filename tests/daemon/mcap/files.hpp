#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/mcap/format/encode.hpp"
#include "daemon/mcap/format/message.hpp"

namespace mpm::test {

/// A message by value, to compare.
struct Kept {
  std::string topic, schema, data;
  std::int64_t log_time_ns = 0, publish_time_ns = 0;
  std::uint32_t sequence = 0;

  bool operator==(const Kept&) const = default;
};

[[nodiscard]] std::vector<Kept> read_all(mcap::MessageSource& source);
[[nodiscard]] mcap::ByteView bytes_of(std::string_view text);

/// MCAP files put together by hand, as other writers may write them.
class HandMade {
 public:
  HandMade();
  void schema(mcap::SchemaId id, std::string_view name);
  void channel(mcap::ChannelId id, mcap::SchemaId schema, std::string_view topic);
  void message(mcap::ChannelId channel, std::uint64_t time_ns, std::string_view data);
  /// What stands between these two becomes a chunk.
  void begin_chunk();
  void end_chunk(std::string_view compression, std::uint64_t start_ns, std::uint64_t end_ns,
                 bool with_crc = true);
  void record(mcap::Op op, std::string_view content);
  /// The end of the data without a CRC, no summary.
  void end();

  [[nodiscard]] mcap::Bytes& bytes() { return bytes_; }
  void save(const std::string& path) const;

 private:
  mcap::Bytes bytes_, outside_;
};

}  // namespace mpm::test
