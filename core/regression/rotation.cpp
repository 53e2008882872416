#include "core/regression/rotation.hpp"

#include <algorithm>
#include <cmath>

#include "core/regression/rotation_kernel.hpp"

namespace mpm {
namespace {

KernelSet pick_kernels() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd"))
    return MPM_KERNELS(kernels_v4);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    return MPM_KERNELS(kernels_v3);
#endif
  return MPM_KERNELS(kernels_base);
}

const KernelSet kKernels = pick_kernels();

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
  kKernels.rotate_rows(x, y, count, rotation.cosine * scale, rotation.sine, rotation.cosine,
                       rotation.sine * scale);
}

void eliminate_row(double* r, double* x, std::size_t count, double entry, double gain) {
  kKernels.eliminate_row(r, x, count, entry, gain);
}

void blend_row(double* r, double* x, std::size_t count, double entry, double gain, double kept) {
  kKernels.blend_row(r, x, count, entry, gain, kept);
}

void project_row(const double* r, double* x, std::size_t count, double entry) {
  kKernels.project_row(r, x, count, entry);
}

void eliminate_heads(double* const* r, const RowBlock& x, const HeadBlock& head) {
  kKernels.eliminate_heads(r, x, head);
}

void eliminate_block(double* const* r, const RowBlock& x, std::size_t count, const double* entries,
                     const double* gains) {
  kKernels.eliminate_block(r, x, count, entries, gains);
}

void project_heads(const double* const* r, const RowBlock& x, const double* magnitudes,
                   double* entries) {
  kKernels.project_heads(r, x, magnitudes, entries);
}

void project_block(const double* const* r, const RowBlock& x, std::size_t count,
                   const double* entries) {
  kKernels.project_block(r, x, count, entries);
}

void inner_products(const double* a, const RowBlock& x, std::size_t count, double* products) {
  kKernels.inner_products(a, x, count, products);
}

void reflect(const double* v, const RowBlock& x, std::size_t count, double factor, double* top) {
  kKernels.reflect(v, x, count, factor, top);
}

void subtract_past(const double* x, std::size_t count, const double* coefficients,
                   std::size_t order, double* left) {
  kKernels.subtract_past(x, count, coefficients, order, left);
}

}  // namespace mpm
