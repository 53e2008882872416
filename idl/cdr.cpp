#include "idl/cdr.hpp"

// Internal headers of Cyclone, of the one version that Debian 12 has: nowhere else.
#include <dds/ddsi/ddsi_cdrstream.h>

#include <cstring>
#include <initializer_list>
#include <limits>
#include <optional>

namespace mpm::idl {
namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr std::uint32_t kXcdr1 = 1;
constexpr std::uint32_t kXcdr2 = 2;

/// How a type goes over the wire.
struct Encoding {
  std::uint8_t id = 0;  // of the little-endian form, in the header's second byte
  std::uint32_t version = kXcdr1;
};

// Final types may come in either version; the other extensibilities exist in the second only.
std::optional<Encoding> encoding_of(const std::uint32_t* ops, std::uint8_t id) {
  ddsi_sertype_extensibility extensibility{};
  if (!dds_stream_extensibility(ops, &extensibility)) return std::nullopt;
  const auto little = static_cast<std::uint8_t>(id | 1U);
  switch (extensibility) {
    case DDSI_SERTYPE_EXT_FINAL:
      if (little == 0x07) return Encoding{little, kXcdr2};
      if (little == 0x01 && dds_stream_minimum_xcdr_version(ops) <= kXcdr1)
        return Encoding{little, kXcdr1};
      return std::nullopt;
    case DDSI_SERTYPE_EXT_APPENDABLE:
      return little == 0x09 ? std::optional(Encoding{little, kXcdr2}) : std::nullopt;
    case DDSI_SERTYPE_EXT_MUTABLE:
      return little == 0x0B ? std::optional(Encoding{little, kXcdr2}) : std::nullopt;
  }
  return std::nullopt;
}

Encoding native_encoding(const std::uint32_t* ops) {
  for (const std::uint8_t id : std::initializer_list<std::uint8_t>{0x01, 0x07, 0x09, 0x0B})
    if (const std::optional<Encoding> encoding = encoding_of(ops, id)) return *encoding;
  return {};
}

}  // namespace

Cdr::~Cdr() = default;

void Cdr::release(void* sample) const { dds_stream_free_sample(sample, type_->m_ops); }

bool Cdr::decode(std::span<const std::byte> bytes, void* sample) {
  if (bytes.size() < kHeaderBytes || bytes.size() > std::numeric_limits<std::uint32_t>::max())
    return false;
  const auto id = std::to_integer<std::uint8_t>(bytes[1]);
  const std::optional<Encoding> encoding = encoding_of(type_->m_ops, id);
  if (bytes[0] != std::byte{0} || !encoding) return false;
  const bool swap = (id & 1U) == 0;

  const std::span<const std::byte> body = bytes.subspan(kHeaderBytes);
  const auto size = static_cast<std::uint32_t>(body.size());
  // Cyclone 0.10.2 takes a number in a sequence for four bytes where that aligns it (XCDR2): it
  // may go twice as far as there are bytes.
  words_.assign(2 * (body.size() / sizeof(std::uint64_t) + 1), 0);
  std::memcpy(words_.data(), body.data(), body.size());
  auto* data = reinterpret_cast<char*>(words_.data());
  // Checks every length and bound, and turns the bytes round; reading trusts it.
  std::uint32_t end = 0;
  if (dds_stream_normalize_data(data, &end, size, swap, encoding->version, type_->m_ops) == nullptr)
    return false;
  dds_istream_t stream;
  dds_istream_init(&stream, end, data, encoding->version);
  dds_stream_read(&stream, static_cast<char*>(sample), type_->m_ops);
  return stream.m_index <= end;
}

std::span<const std::byte> Cdr::encode(const void* sample) {
  const Encoding encoding = native_encoding(type_->m_ops);
  dds_ostreamLE_t stream;
  dds_ostreamLE_init(&stream, 256, encoding.version);
  dds_stream_writeLE(&stream, static_cast<const char*>(sample), type_->m_ops);
  const std::size_t size = stream.x.m_index;
  const std::size_t padding = (4 - size % 4) % 4;
  bytes_.assign(kHeaderBytes + size + padding, std::byte{0});
  bytes_[1] = std::byte{encoding.id};
  bytes_[3] = static_cast<std::byte>(padding);
  std::memcpy(bytes_.data() + kHeaderBytes, stream.x.m_buffer, size);
  dds_ostreamLE_fini(&stream);
  return bytes_;
}

}  // namespace mpm::idl
