#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "daemon/mcap/format/format.hpp"

namespace mpm::mcap {

/// Unpacks chunks: zstd, lz4 and what is not packed.
class Unpacker {
 public:
  Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;
  ~Unpacker();

  /// Into `out`, which never grows far beyond what really comes, nor beyond `size`. Returns what is
  /// wrong, in words; `out` then holds what came before that. Empty: exactly `size` bytes came.
  [[nodiscard]] std::string unpack(std::string_view compression, ByteView packed,
                                   std::uint64_t size, Bytes& out);

 private:
  struct Contexts;
  std::unique_ptr<Contexts> contexts_;
};

}  // namespace mpm::mcap
