#pragma once

#include <cstring>
#include <string_view>
#include <utility>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// Appends fields of records to `out`.
class Encoder {
 public:
  explicit Encoder(Bytes& out) : out_(out) {}

  void u8(std::uint8_t value) { out_.push_back(std::byte{value}); }
  void u16(std::uint16_t value) { integer(value); }
  void u32(std::uint32_t value) { integer(value); }
  void u64(std::uint64_t value) { integer(value); }
  void bytes(ByteView bytes);
  void text(std::string_view text) {
    u32(static_cast<std::uint32_t>(text.size()));
    bytes(std::as_bytes(std::span(text)));
  }
  void map(const TextMap& map) {
    const std::size_t begin = out_.size();
    u32(0);
    for (const auto& [key, value] : map) {
      text(key);
      text(value);
    }
    const auto length = static_cast<std::uint32_t>(out_.size() - begin - sizeof(std::uint32_t));
    std::memcpy(out_.data() + begin, &length, sizeof length);
  }

  /// Calls `fields()`, which appends the record's content, and fills in its length.
  template <class Fields>
  void record(Op op, Fields&& fields) {
    u8(static_cast<std::uint8_t>(op));
    const std::size_t begin = out_.size();
    u64(0);
    std::forward<Fields>(fields)();
    const std::uint64_t length = out_.size() - begin - sizeof(std::uint64_t);
    std::memcpy(out_.data() + begin, &length, sizeof length);
  }

 private:
  // The format's byte order is that of every machine this is built for.
  template <class Integer>
  void integer(Integer value) {
    bytes(std::as_bytes(std::span(&value, 1)));
  }

  Bytes& out_;
};

}  // namespace mpm::mcap
