#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace mpm::bag {

/// One recording of a folder: a file, those of one that was split, or a folder of files.
struct ListedRecording {
  std::string name;  ///< in its folder: "monday.mcap", "monday-*.mcap" or "monday/"
  std::vector<std::string> files;
  std::optional<std::int64_t> start_ns, end_ns;  ///< log times; nothing where there is no message
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
  std::set<std::string> units;  ///< of the beginnings and ends of its files
  std::string problem;          ///< why it is not whole; empty where it is
};

/// The recordings in `folder`, by their start. Of a whole file that has an index only the heads of
/// its records, the first chunk and the last one are read, of any other all of it. Throws
/// config::InputError where it is no folder.
[[nodiscard]] std::vector<ListedRecording> list_recordings(const std::string& folder);

}  // namespace mpm::bag
