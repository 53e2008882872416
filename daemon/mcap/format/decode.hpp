#pragma once

#include <cstring>
#include <string_view>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// Takes fields off a record. What is not there reads as zero or empty, and `ok()` is false from
/// then on: check it before believing anything.
class Decoder {
 public:
  explicit Decoder(ByteView bytes) : rest_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] ByteView rest() const { return rest_; }
  std::uint8_t u8() { return integer<std::uint8_t>(); }
  std::uint16_t u16() { return integer<std::uint16_t>(); }
  std::uint32_t u32() { return integer<std::uint32_t>(); }
  std::uint64_t u64() { return integer<std::uint64_t>(); }
  ByteView bytes(std::uint64_t count) {
    if (count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const ByteView taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  std::string_view text() {
    const ByteView taken = bytes(u32());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
  TextMap map() {
    TextMap map;
    Decoder entries(bytes(u32()));
    while (entries.ok() && !entries.rest().empty()) {
      const std::string_view key = entries.text();
      map.insert_or_assign(std::string(key), std::string(entries.text()));
    }
    ok_ = ok_ && entries.ok();
    return map;
  }

 private:
  template <class Integer>
  Integer integer() {
    Integer value = 0;
    const ByteView taken = bytes(sizeof value);
    if (!taken.empty()) std::memcpy(&value, taken.data(), sizeof value);
    return value;
  }

  ByteView rest_;
  bool ok_ = true;
};

}  // namespace mpm::mcap
