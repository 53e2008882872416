// Compiled once per instruction set, each with its own MPM_KERNEL_NAME (core/CMakeLists.txt).
#include "core/regression/rotation_kernel.hpp"

namespace mpm {

void MPM_KERNEL_NAME(double* __restrict x, double* __restrict y, std::size_t count, double xx,
                     double xy, double yy, double yx) {
  for (std::size_t i = 0; i < count; ++i) {
    const double old_x = x[i];
    const double old_y = y[i];
    x[i] = xx * old_x + xy * old_y;
    y[i] = yy * old_y - yx * old_x;
  }
}

}  // namespace mpm
