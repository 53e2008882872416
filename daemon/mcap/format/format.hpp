#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

/// MCAP, the container format of recordings (mcap.dev, specification of version 0): a data section
/// of records, mostly chunks of messages, then a summary with an index. All integers are
/// little-endian; a record is its opcode (1 byte), its length (8 bytes) and as many bytes.
namespace mpm::mcap {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// Kinds of records; others are the future's or another program's, and are passed over.
enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// A file begins and ends with these; the 0 is the version.
inline constexpr std::array<std::byte, 8> kMagic = {std::byte{0x89}, std::byte{'M'}, std::byte{'C'},
                                                    std::byte{'A'},  std::byte{'P'}, std::byte{'0'},
                                                    std::byte{'\r'}, std::byte{'\n'}};

inline constexpr std::size_t kRecordHead = 9;  ///< bytes of opcode and length
inline constexpr std::size_t kFooterBytes = 20;

/// No record but an attachment is longer than this, and no chunk once it is unpacked: what claims
/// more is damaged, or hostile.
inline constexpr std::uint64_t kMostBytes = 256ULL << 20U;

using SchemaId = std::uint16_t;
using ChannelId = std::uint16_t;
using TextMap = std::map<std::string, std::string>;

/// What the messages of a channel look like.
struct Schema {
  SchemaId id = 0;
  std::string name;      ///< of the type, e.g. `mpm::Sample`
  std::string encoding;  ///< of `data`: omgidl, jsonschema, ros2msg ...; empty = none
  std::string data;      ///< e.g. the IDL text

  bool operator==(const Schema&) const = default;
};

/// The messages of one topic.
struct Channel {
  ChannelId id = 0;
  SchemaId schema_id = 0;  ///< 0 = no schema
  std::string topic;
  std::string message_encoding;  ///< cdr, json ...
  TextMap metadata;

  bool operator==(const Channel&) const = default;
};

}  // namespace mpm::mcap
