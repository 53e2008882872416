#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mpm::bag {

inline constexpr std::string_view kExtension = ".mcap";

/// The name of a file of a recording that was split: "monday-0002.mcap".
struct SplitName {
  std::string stem;
  int number = 0;
};

/// STEM-NNNN.mcap, of four to nine digits; nothing for any other name.
[[nodiscard]] std::optional<SplitName> split_name(const std::string& file_name);

}  // namespace mpm::bag
