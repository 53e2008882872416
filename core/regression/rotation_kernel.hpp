#pragma once

#include <cstddef>

/// The long loops, once per instruction set; picked in rotation.cpp, described in rotation.hpp.
#define MPM_DECLARE_KERNELS(set)                                                                   \
  namespace mpm::set {                                                                             \
  void rotate_rows(double* x, double* y, std::size_t count, double xx, double xy, double yy,       \
                   double yx);                                                                     \
  void eliminate_row(double* r, double* x, std::size_t count, double entry, double gain);          \
  void eliminate_rows(double* const* r, double* x, std::size_t count, const double* entries,       \
                      const double* gains);                                                        \
  void blend_row(double* r, double* x, std::size_t count, double entry, double gain, double kept); \
  void project_row(const double* r, double* x, std::size_t count, double entry);                   \
  void project_rows(const double* const* r, double* x, std::size_t count, const double* entries);  \
  }

MPM_DECLARE_KERNELS(kernels_base)
MPM_DECLARE_KERNELS(kernels_v3)
MPM_DECLARE_KERNELS(kernels_v4)
