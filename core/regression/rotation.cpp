#include "core/regression/rotation.hpp"

#include <algorithm>
#include <cmath>

#include "core/regression/rotation_kernel.hpp"

namespace mpm {
namespace {

using Kernel = void (*)(double*, double*, std::size_t, double, double, double, double);

Kernel pick_kernel() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    return rotate_rows_v4;
  if (__builtin_cpu_supports("avx2")) return rotate_rows_v3;
#endif
  return rotate_rows_base;
}

const Kernel kKernel = pick_kernel();

}  // namespace

Rotation make_rotation(double a, double b) {
  if (b == 0.0) return {a < 0.0 ? -1.0 : 1.0, 0.0, std::abs(a)};
  const double square = a * a + b * b;
  if (square > 1e-280 && square < 1e280) {
    const double radius = std::sqrt(square);
    const double inverse = 1.0 / radius;
    return {a * inverse, b * inverse, radius};
  }
  const double largest = std::max(std::abs(a), std::abs(b));
  const double scaled_a = a / largest;
  const double scaled_b = b / largest;
  const double norm = std::sqrt(scaled_a * scaled_a + scaled_b * scaled_b);
  return {scaled_a / norm, scaled_b / norm, largest * norm};
}

void rotate_rows(double* x, double* y, std::size_t count, const Rotation& rotation, double scale) {
  kKernel(x, y, count, rotation.cosine * scale, rotation.sine, rotation.cosine,
          rotation.sine * scale);
}

}  // namespace mpm
