#pragma once

#include <string>

#include "config/finding.hpp"

namespace mpm::bag {

/// Throws config::InputError about a file as a whole.
[[noreturn]] inline void refuse(const std::string& path, const std::string& message) {
  throw config::InputError({path, 0, 0, config::Severity::kError, "", message});
}

}  // namespace mpm::bag
