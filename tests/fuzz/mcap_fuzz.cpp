// libFuzzer: any bytes as an MCAP file. Built with clang and -DMPM_FUZZ=ON.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "tests/fuzz/exercise_mcap.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("input.mcap", 0);
  static const int scratch = memfd_create("mended.mcap", 0);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size))
    return 0;
  mpm::test::exercise_mcap("/proc/self/fd/" + std::to_string(file),
                           "/proc/self/fd/" + std::to_string(scratch));
  return 0;
}
