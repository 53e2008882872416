// Compiled once per instruction set, each with its own MPM_KERNEL_SET (core/CMakeLists.txt).
#include "core/regression/rotation_kernel.hpp"

namespace mpm::MPM_KERNEL_SET {

void rotate_rows(double* __restrict x, double* __restrict y, std::size_t count, double xx,
                 double xy, double yy, double yx) {
  for (std::size_t i = 0; i < count; ++i) {
    const double old_x = x[i];
    const double old_y = y[i];
    x[i] = xx * old_x + xy * old_y;
    y[i] = yy * old_y - yx * old_x;
  }
}

void eliminate_row(double* __restrict r, double* __restrict x, std::size_t count, double entry,
                   double gain) {
  for (std::size_t i = 0; i < count; ++i) {
    const double left = x[i] - entry * r[i];
    r[i] = r[i] + gain * left;
    x[i] = left;
  }
}

// Eight rows in one pass keep x in a register: one load and store of x instead of eight.
void eliminate_rows(double* const* r, double* __restrict x, std::size_t count,
                    const double* entries, const double* gains) {
  double* __restrict r0 = r[0];
  double* __restrict r1 = r[1];
  double* __restrict r2 = r[2];
  double* __restrict r3 = r[3];
  double* __restrict r4 = r[4];
  double* __restrict r5 = r[5];
  double* __restrict r6 = r[6];
  double* __restrict r7 = r[7];
  const double e0 = entries[0], e1 = entries[1], e2 = entries[2], e3 = entries[3];
  const double e4 = entries[4], e5 = entries[5], e6 = entries[6], e7 = entries[7];
  const double g0 = gains[0], g1 = gains[1], g2 = gains[2], g3 = gains[3];
  const double g4 = gains[4], g5 = gains[5], g6 = gains[6], g7 = gains[7];
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    double left = x[i];
    left = left - e0 * r0[i];
    r0[i] = r0[i] + g0 * left;
    left = left - e1 * r1[i];
    r1[i] = r1[i] + g1 * left;
    left = left - e2 * r2[i];
    r2[i] = r2[i] + g2 * left;
    left = left - e3 * r3[i];
    r3[i] = r3[i] + g3 * left;
    left = left - e4 * r4[i];
    r4[i] = r4[i] + g4 * left;
    left = left - e5 * r5[i];
    r5[i] = r5[i] + g5 * left;
    left = left - e6 * r6[i];
    r6[i] = r6[i] + g6 * left;
    left = left - e7 * r7[i];
    r7[i] = r7[i] + g7 * left;
    x[i] = left;
  }
}

void blend_row(double* __restrict r, double* __restrict x, std::size_t count, double entry,
               double gain, double kept) {
  for (std::size_t i = 0; i < count; ++i) {
    const double old_x = x[i];
    x[i] = old_x - entry * r[i];
    r[i] = kept * r[i] + gain * old_x;
  }
}

void project_row(const double* __restrict r, double* __restrict x, std::size_t count,
                 double entry) {
  for (std::size_t i = 0; i < count; ++i) x[i] = x[i] - entry * r[i];
}

void project_rows(const double* const* r, double* __restrict x, std::size_t count,
                  const double* entries) {
  const double *r0 = r[0], *r1 = r[1], *r2 = r[2], *r3 = r[3];
  const double *r4 = r[4], *r5 = r[5], *r6 = r[6], *r7 = r[7];
  const double e0 = entries[0], e1 = entries[1], e2 = entries[2], e3 = entries[3];
  const double e4 = entries[4], e5 = entries[5], e6 = entries[6], e7 = entries[7];
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    double left = x[i] - e0 * r0[i];
    left = left - e1 * r1[i];
    left = left - e2 * r2[i];
    left = left - e3 * r3[i];
    left = left - e4 * r4[i];
    left = left - e5 * r5[i];
    left = left - e6 * r6[i];
    x[i] = left - e7 * r7[i];
  }
}

}  // namespace mpm::MPM_KERNEL_SET
