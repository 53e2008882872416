#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mpm::live {

/// A file of a series in `folder`: PREFIX000000000012. Names sort as the numbers do.
[[nodiscard]] std::string numbered_path(const std::string& folder, std::string_view prefix,
                                        std::uint64_t number);
/// The numbers of those that there are, ascending; none where the folder cannot be read.
[[nodiscard]] std::vector<std::uint64_t> numbers_in(const std::string& folder,
                                                    std::string_view prefix);

}  // namespace mpm::live
