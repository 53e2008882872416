#include "daemon/host/memory.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace mpm::host {
namespace {

double resident_mb() {
  constexpr double kPageMb = 4096.0 / 1e6;
  std::ifstream statm("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  statm >> all >> resident;
  return resident * kPageMb;
}

// Of blocks too small to be mapped one by one the C library keeps all below one that is still used.
TEST_CASE("memory that was freed goes back to the system") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return;  // these have an allocator of their own
#endif
  constexpr std::size_t kBlocks = 100'000, kBytes = 1000;
  const double before = resident_mb();
  std::vector<std::unique_ptr<std::string>> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i)
    blocks.push_back(std::make_unique<std::string>(kBytes, 'x'));
  const auto last = std::move(blocks.back());
  CHECK(resident_mb() > before + 90.0);
  blocks.clear();
  CHECK(resident_mb() > before + 50.0);
  give_memory_back();
  CHECK(resident_mb() < before + 20.0);
}

}  // namespace
}  // namespace mpm::host
