#pragma once

#include <string>
#include <string_view>

#include "config/unit_config.hpp"

namespace mpm::fuzz {

/// Two MVs, a DV and two CVs, calculated and auxiliary signals, and a memory so short that it comes
/// round in a few hundred samples.
[[nodiscard]] const config::UnitConfig& small_unit();

/// A file of those bytes, by a name that can be opened until the next call; in memory.
[[nodiscard]] std::string as_file(std::string_view bytes);
/// An empty folder of this process, in memory where there is /dev/shm. What is put there goes with
/// the process, or by `remove`.
[[nodiscard]] const std::string& folder();

}  // namespace mpm::fuzz
