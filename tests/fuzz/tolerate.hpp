#pragma once

#include <stdexcept>
#include <string>

#include "config/finding.hpp"

namespace mpm::fuzz {

/// Runs `work`, which may end in a config::InputError of one line; true where it did not.
template <class Work>
bool tolerate(Work&& work) {
  try {
    work();
    return true;
  } catch (const config::InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos)
      throw std::logic_error("an error of more than one line");
    return false;
  }
}

inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace mpm::fuzz
