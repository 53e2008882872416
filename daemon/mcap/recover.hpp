#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/mcap/write/writer.hpp"

namespace mpm::mcap {

/// What became of a torn or damaged file.
struct RecoverReport {
  bool whole = false;  ///< nothing was wrong with it
  std::uint64_t messages = 0;
  std::uint64_t channels = 0;
  std::uint64_t chunks = 0;           ///< of the new file
  std::uint64_t torn_messages = 0;    ///< of the messages: from a chunk that was cut off
  std::uint64_t lost_bytes = 0;       ///< of the old file, not understood
  std::vector<std::string> problems;  ///< `byte N: what`, in the order of the file
};

/// Writes what can be read of `input` into `output` as a whole file with an index: all of the
/// chunks that are right, all messages before the tear in the one that is cut off, and what comes
/// behind a damaged stretch. Memory as for reading. Throws config::InputError where `input` is no
/// MCAP file, std::runtime_error where `output` cannot be written.
[[nodiscard]] RecoverReport recover(const std::string& input, const OutputPlace& output);

}  // namespace mpm::mcap
