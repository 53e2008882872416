#pragma once

#include <optional>
#include <set>
#include <vector>

#include "daemon/mcap/read/chunk.hpp"

namespace mpm::mcap {

/// A chunk in a file.
struct ChunkPlace {
  std::uint64_t offset = 0;  ///< of its record
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
};

/// A file as its records' heads show it: nothing is unpacked.
struct FileLayout {
  std::vector<ChunkPlace> chunks;      ///< in the order of the file
  std::set<std::string> compressions;  ///< of the chunks; "" = none
  std::uint64_t packed_bytes = 0;      ///< of the chunks' records
  std::uint64_t unpacked_bytes = 0;
  Definitions definitions;                ///< those outside of chunks
  bool messages_outside = false;          ///< there are messages outside of chunks
  std::optional<std::uint64_t> messages;  ///< as the index counts them, where it does
  std::optional<Damage> damage;           ///< where the walk ended, if not at the end of the file
};

/// Reads the heads of all records. A file that no index describes is told by this as well as any.
/// Fails only where the file is no MCAP file or cannot be read.
[[nodiscard]] FileLayout scan(InputFile& file);

/// Why the index at the end of a whole file cannot be relied on, in words; empty where it can: its
/// CRC is right and it names these chunks and as many messages.
[[nodiscard]] std::string index_problem(InputFile& file, const FileLayout& layout,
                                        std::uint64_t messages);

}  // namespace mpm::mcap
