// libFuzzer: the target that MPM_FUZZ_TARGET names, for MPM_FUZZ_CPU_MINUTES. `./run fuzz` builds
// and runs it.
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "tests/fuzz/targets.hpp"

namespace {

const mpm::fuzz::Target& chosen() {
  const char* name = std::getenv("MPM_FUZZ_TARGET");
  for (const mpm::fuzz::Target& target : mpm::fuzz::targets())
    if (name != nullptr && target.name == std::string_view(name)) return target;
  std::fputs("MPM_FUZZ_TARGET must name one of", stderr);
  for (const mpm::fuzz::Target& target : mpm::fuzz::targets())
    std::fprintf(stderr, " %s", target.name);
  std::fputs("\n", stderr);
  std::exit(3);
}

/// libFuzzer's own limit is of the wall, and says nothing on a machine that has other work.
void end_in_time() {
  static const char* minutes = std::getenv("MPM_FUZZ_CPU_MINUTES");
  static const double limit_s = minutes == nullptr ? 0.0 : 60.0 * std::atof(minutes);
  static unsigned turns = 0;
  if (limit_s > 0.0 && ++turns % 32 == 0 &&
      static_cast<double>(std::clock()) / CLOCKS_PER_SEC > limit_s)
    std::raise(SIGINT);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const mpm::fuzz::Target& target = chosen();
  end_in_time();
  target.exercise({reinterpret_cast<const char*>(data), size});
  return 0;
}
