#include "daemon/mcap/crc32.hpp"

namespace mpm::mcap {
namespace {

constexpr std::size_t kStride = 8;
using Table = std::array<std::uint32_t, 256>;

// tables[k][b]: what byte b does to the state when k more bytes follow it.
constexpr std::array<Table, kStride> make_tables() {
  std::array<Table, kStride> tables{};
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    tables[0][b] = crc;
  }
  for (std::size_t k = 1; k < kStride; ++k)
    for (std::size_t b = 0; b < 256; ++b)
      tables[k][b] = (tables[k - 1][b] >> 8U) ^ tables[0][tables[k - 1][b] & 0xFFU];
  return tables;
}

constexpr std::array<Table, kStride> kTables = make_tables();

std::uint32_t at(ByteView bytes, std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); }

}  // namespace

void Crc32::add(ByteView bytes) {
  std::uint32_t crc = state_;
  std::size_t i = 0;
  for (; i + kStride <= bytes.size(); i += kStride) {
    crc ^=
        at(bytes, i) | at(bytes, i + 1) << 8U | at(bytes, i + 2) << 16U | at(bytes, i + 3) << 24U;
    crc = kTables[7][crc & 0xFFU] ^ kTables[6][(crc >> 8U) & 0xFFU] ^
          kTables[5][(crc >> 16U) & 0xFFU] ^ kTables[4][crc >> 24U] ^ kTables[3][at(bytes, i + 4)] ^
          kTables[2][at(bytes, i + 5)] ^ kTables[1][at(bytes, i + 6)] ^
          kTables[0][at(bytes, i + 7)];
  }
  for (; i < bytes.size(); ++i) crc = (crc >> 8U) ^ kTables[0][(crc ^ at(bytes, i)) & 0xFFU];
  state_ = crc;
}

std::uint32_t crc32(ByteView bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace mpm::mcap
