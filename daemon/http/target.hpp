#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm::http {

/// The target of a request, taken apart and decoded. A name with `/` in it is one part of the path.
struct Target {
  std::vector<std::string> path;
  std::map<std::string, std::string> query;
};

/// Nothing where it is none: no `/` first, or a `%` without two digits.
[[nodiscard]] std::optional<Target> parse_target(std::string_view text);

}  // namespace mpm::http
