#pragma once

#include <cstddef>

/// The builds of one loop, x' = xx x + xy y, y' = yy y - yx x; private to rotation.cpp.
namespace mpm {

void rotate_rows_base(double* x, double* y, std::size_t count, double xx, double xy, double yy,
                      double yx);
void rotate_rows_v3(double* x, double* y, std::size_t count, double xx, double xy, double yy,
                    double yx);
void rotate_rows_v4(double* x, double* y, std::size_t count, double xx, double xy, double yy,
                    double yx);

}  // namespace mpm
