#pragma once

#include <cstdint>

namespace mpm::test {

/// Heap allocations of this process so far, by operator new or malloc alike (Eigen uses the
/// latter). Always 0 under a sanitizer, which brings its own allocator.
[[nodiscard]] std::uint64_t allocation_count();

/// False under a sanitizer, whose shadow and quarantine a bound on resident memory would measure.
[[nodiscard]] constexpr bool resident_memory_is_ours() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

}  // namespace mpm::test
