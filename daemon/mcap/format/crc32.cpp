#include "daemon/mcap/format/crc32.hpp"

#include <zlib.h>

namespace mpm::mcap {

void Crc32::add(ByteView bytes) {
  if (bytes.empty()) return;  // without an address zlib would begin anew
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  value_ = static_cast<std::uint32_t>(crc32_z(value_, data, bytes.size()));
}

std::uint32_t crc32(ByteView bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace mpm::mcap
