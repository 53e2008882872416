#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace mpm::report {

/// ", of y1 (9), u1 (2)": whose values are bad, those with most first and three at most; empty
/// where none are.
[[nodiscard]] std::string worst_tags(std::vector<std::pair<std::string, std::uint64_t>> bad_values);

}  // namespace mpm::report
