#pragma once

#include <cstdint>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// CRC-32 as in Ethernet and zip, fed piece by piece.
class Crc32 {
 public:
  void add(ByteView bytes);
  [[nodiscard]] std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 0;
};

[[nodiscard]] std::uint32_t crc32(ByteView bytes);

}  // namespace mpm::mcap
