#pragma once

#include <memory>
#include <string_view>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

enum class Compression { kNone, kZstd };

/// As chunks name it: "" or "zstd".
[[nodiscard]] std::string_view name_of(Compression compression);

/// Packs one chunk after the other with the same memory.
class Compressor {
 public:
  explicit Compressor(Compression compression);
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;
  ~Compressor();

  /// Valid until the next call, or until `bytes` change.
  [[nodiscard]] ByteView pack(ByteView bytes);

 private:
  struct Context;
  std::unique_ptr<Context> context_;  // null = no compression
  Bytes packed_;
};

}  // namespace mpm::mcap
