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
  void reflect(const double* v, const RowBlock& x, std::size_t count, double factor, double* top); \
  void subtract_past(const double* x, std::size_t count, const double* coefficients,               \
                     std::size_t order, double* left);                                             \
  }

MPM_DECLARE_KERNELS(kernels_base)
MPM_DECLARE_KERNELS(kernels_v3)
MPM_DECLARE_KERNELS(kernels_v4)

namespace mpm {

/// All of one instruction set.
struct KernelSet {
  decltype(&kernels_base::rotate_rows) rotate_rows;
  decltype(&kernels_base::eliminate_row) eliminate_row;
  decltype(&kernels_base::blend_row) blend_row;
  decltype(&kernels_base::project_row) project_row;
  decltype(&kernels_base::eliminate_heads) eliminate_heads;
  decltype(&kernels_base::eliminate_block) eliminate_block;
  decltype(&kernels_base::project_heads) project_heads;
  decltype(&kernels_base::project_block) project_block;
  decltype(&kernels_base::inner_products) inner_products;
  decltype(&kernels_base::reflect) reflect;
  decltype(&kernels_base::subtract_past) subtract_past;
};

#define MPM_KERNELS(set)                                                                   \
  ::mpm::KernelSet {                                                                       \
    ::mpm::set::rotate_rows, ::mpm::set::eliminate_row, ::mpm::set::blend_row,             \
        ::mpm::set::project_row, ::mpm::set::eliminate_heads, ::mpm::set::eliminate_block, \
        ::mpm::set::project_heads, ::mpm::set::project_block, ::mpm::set::inner_products,  \
        ::mpm::set::reflect, ::mpm::set::subtract_past                                     \
  }

}  // namespace mpm
