#pragma once

#include <cstdint>

namespace mpm::test {

/// Heap allocations of this process so far, by operator new or malloc alike (Eigen uses the
/// latter). Always 0 under a sanitizer, which brings its own allocator.
[[nodiscard]] std::uint64_t allocation_count();

}  // namespace mpm::test
