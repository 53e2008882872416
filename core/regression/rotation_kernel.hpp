#pragma once

#include <cstddef>

#include "core/regression/rotation.hpp"

/// The long loops, once per instruction set; picked in rotation.cpp, described in rotation.hpp.
#define MPM_DECLARE_KERNELS(set)                                                                   \
  namespace mpm::set {                                                                             \
  void rotate_rows(double* x, double* y, std::size_t count, double xx, double xy, double yy,       \
                   double yx);                                                                     \
  void eliminate_row(double* r, double* x, std::size_t count, double entry, double gain);          \
  void blend_row(double* r, double* x, std::size_t count, double entry, double gain, double kept); \
  void project_row(const double* r, double* x, std::size_t count, double entry);                   \
  void eliminate_heads(double* const* r, const RowBlock& x, const HeadBlock& head);                \
  void eliminate_block(double* const* r, const RowBlock& x, std::size_t count,                     \
                       const double* entries, const double* gains);                                \
  void project_heads(const double* const* r, const RowBlock& x, const double* magnitudes,          \
                     double* entries);                                                             \
  void project_block(const double* const* r, const RowBlock& x, std::size_t count,                 \
                     const double* entries);                                                       \
  void inner_products(const double* a, const RowBlock& x, std::size_t count, double* products);    \
  }

MPM_DECLARE_KERNELS(kernels_base)
MPM_DECLARE_KERNELS(kernels_v3)
MPM_DECLARE_KERNELS(kernels_v4)
