#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace mpm::test {

/// Expected numbers that a script in tests/oracles wrote.
inline nlohmann::json read_oracle(const std::string& name) {
  std::ifstream file(MPM_SOURCE_DIR "/tests/oracles/" + name);
  return nlohmann::json::parse(file);
}

}  // namespace mpm::test
