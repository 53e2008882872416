#pragma once

#include <cstddef>

/// The numerical kernel of this project: plane (Givens) rotations of long rows.
///
/// The loops are compiled for several instruction sets and picked once at start. All of them give
/// the same bits: the operations are element-wise and no multiply-add is contracted.
namespace mpm {

/// Alignment of rows, bytes; and the same in doubles.
inline constexpr std::size_t kRowAlignment = 64;
inline constexpr std::size_t kRowGranule = kRowAlignment / sizeof(double);

/// Cosine, sine and radius of the rotation that takes (a, b) to (radius, 0), radius >= 0.
struct Rotation {
  double cosine = 1.0;
  double sine = 0.0;
  double radius = 0.0;
};
/// No overflow or underflow for any finite a, b; (0, 0) gives the identity.
[[nodiscard]] Rotation make_rotation(double a, double b);

/// [x; y] <- [c s; -s c] [diag(scale, 1)] [x; y], element by element over `count` values:
/// x' = (c * scale) x + s y, y' = c y - (s * scale) x. `x` and `y` must not overlap.
void rotate_rows(double* x, double* y, std::size_t count, const Rotation& rotation,
                 double scale = 1.0);

/// Square-root-free rotation of a row r with unit diagonal and a row x (Gentleman 1973):
/// x' = x - entry r, r' = r + gain x'. No overlap.
void eliminate_row(double* r, double* x, std::size_t count, double entry, double gain);
/// The same with kRowGranule rows one after the other, in one pass.
void eliminate_rows(double* const* r, double* x, std::size_t count, const double* entries,
                    const double* gains);
/// The same as eliminate_row, with r' = kept r + gain x, kept = 1 - gain entry: one multiplication
/// more, and no cancellation where little of the old row is kept.
void blend_row(double* r, double* x, std::size_t count, double entry, double gain, double kept);
/// Only x' = x - entry r.
void project_row(const double* r, double* x, std::size_t count, double entry);
/// The same with kRowGranule rows one after the other, in one pass.
void project_rows(const double* const* r, double* x, std::size_t count, const double* entries);

}  // namespace mpm
