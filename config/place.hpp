#pragma once

#include <string>

namespace mpm::config {

/// Where something stands that was read; line 0 = nowhere in a file.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key;  ///< such as `changes[1]`
};

}  // namespace mpm::config
