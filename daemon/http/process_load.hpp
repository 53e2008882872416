#pragma once

#include <cstdint>

namespace mpm::http {

/// What this process takes of its machine.
struct ProcessLoad {
  std::uint64_t resident_bytes = 0;  ///< 0 where the kernel does not say
  double processor_seconds = 0.0;    ///< of all threads, since the start
};

[[nodiscard]] ProcessLoad process_load();

}  // namespace mpm::http
