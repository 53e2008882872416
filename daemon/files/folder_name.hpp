#pragma once

#include <cstdint>
#include <string>

namespace mpm::files {

/// "20240501T120000Z" of ns since 1970, with milliseconds where there are any.
[[nodiscard]] std::string time_folder(std::int64_t time_ns);
/// A name from outside, of a unit or a tag, as (part of) the name of a folder: whatever a path
/// might misread is %XX.
[[nodiscard]] std::string folder_name(const std::string& name);

}  // namespace mpm::files
