#pragma once

#include <cstddef>

/// The numerical kernel of this project: plane (Givens) rotations of long rows, and the two long
/// loops of a least-squares fit.
///
/// The loops are compiled for several instruction sets and picked once at start. All of them give
/// the same bits: the operations are element-wise and each multiply-add is rounded once, as the
/// code says, none as the compiler likes.
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
/// The same as eliminate_row, with r' = kept r + gain x, kept = 1 - gain entry: one multiplication
/// more, and no cancellation where little of the old row is kept.
void blend_row(double* r, double* x, std::size_t count, double entry, double gain, double kept);
/// Only x' = x - entry r.
void project_row(const double* r, double* x, std::size_t count, double entry);

/// Consecutive rows, each `stride` doubles after the one before.
struct RowBlock {
  double* first;
  std::size_t stride;
  int rows;
};

/// What eliminating kRowGranule columns of a block of rows needs to know and finds out, beside the
/// rows. Per row and column arrays have kRowGranule values a row, unless said otherwise.
struct HeadBlock {
  double lambda;
  double* weights;               // of the kRowGranule stored rows
  double* inverse_row_weights;   // one per row
  const double* magnitudes;      // of the columns, as of each row
  std::size_t magnitude_stride;  // from row to row
  double* entries;               // out: of the rows, 0 where they are noise
  double* gains;                 // out
  double* kept;                  // out
};

/// Rotates the entries of a block of rows in kRowGranule columns, row after row, into the triangle
/// of as many stored rows `r`: granules that begin at the first of these columns.
void eliminate_heads(double* const* r, const RowBlock& x, const HeadBlock& head);
/// eliminate_row for each of kRowGranule stored rows and each of a block of rows, one after the
/// other, with the bits of that many calls; the stored rows stay in registers meanwhile. `count`
/// and the alignment of all rows are multiples of a granule.
void eliminate_block(double* const* r, const RowBlock& x, std::size_t count, const double* entries,
                     const double* gains);
/// The same two for rows that are only projected: nothing stored changes.
void project_heads(const double* const* r, const RowBlock& x, const double* magnitudes,
                   double* entries);
void project_block(const double* const* r, const RowBlock& x, std::size_t count,
                   const double* entries);
/// Inner products of `a` with each row of x, `count` (whole granules) values each.
void inner_products(const double* a, const RowBlock& x, std::size_t count, double* products);

/// Householder's reflection of columns, each a row of `x` here and one value of `top` above it:
/// with share = factor (top + v' x), top' = top - share and x' = x - share v. `v` and each column
/// have `count` values, a multiple of a granule; no alignment is asked, and no overlap is allowed.
void reflect(const double* v, const RowBlock& x, std::size_t count, double factor, double* top);
/// left_k = x_k - sum over l = 1..order of coefficients_(l-1) x_(k-l), for k = order..count-1,
/// summed in that order; the `order` values before are left alone. No overlap.
void subtract_past(const double* x, std::size_t count, const double* coefficients,
                   std::size_t order, double* left);

}  // namespace mpm
