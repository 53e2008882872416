#pragma once

#include <cstdint>

#include "daemon/mcap/format.hpp"

namespace mpm::mcap {

/// CRC-32 as in Ethernet and zip (reflected polynomial 0xEDB88320), fed piece by piece.
class Crc32 {
 public:
  void add(ByteView bytes);
  [[nodiscard]] std::uint32_t value() const { return ~state_; }

 private:
  std::uint32_t state_ = 0xFFFFFFFFU;
};

[[nodiscard]] std::uint32_t crc32(ByteView bytes);

}  // namespace mpm::mcap
