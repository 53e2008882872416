#pragma once

#include <string_view>

namespace mpm::http {

/// A file of the page, embedded in the program.
struct Asset {
  std::string_view path, type, bytes;
  std::string_view etag;  ///< of its bytes, in quotes
};

/// Null where there is none. `path`: as a browser asks, "/" for the page itself.
[[nodiscard]] const Asset* find_asset(std::string_view path);

}  // namespace mpm::http
