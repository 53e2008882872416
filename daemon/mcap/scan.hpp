#pragma once

#include <optional>
#include <vector>

#include "daemon/mcap/chunk.hpp"

namespace mpm::mcap {

/// A chunk in a file.
struct ChunkPlace {
  std::uint64_t offset = 0;  ///< of its record
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
};

/// A file as its records' heads show it: nothing is unpacked.
struct FileLayout {
  std::vector<ChunkPlace> chunks;  ///< in the order of the file
  Definitions definitions;         ///< those outside of chunks
  bool messages_outside = false;   ///< there are messages outside of chunks
  std::optional<Damage> damage;    ///< where the walk ended, if not at the end of the file
};

/// Reads the heads of all records. A file that no index describes is told by this as well as any.
/// Fails only where the file is no MCAP file or cannot be read.
[[nodiscard]] FileLayout scan(InputFile& file);

}  // namespace mpm::mcap
