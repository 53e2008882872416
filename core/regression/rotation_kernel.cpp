// Compiled once per instruction set, each with its own MPM_KERNEL_SET (core/CMakeLists.txt).
#include "core/regression/rotation_kernel.hpp"

#include "core/regression/calibration.hpp"

#if defined(__FMA__)
#include <immintrin.h>
#endif

namespace mpm::MPM_KERNEL_SET {
namespace {

// As many values as one register of this instruction set holds; and a granule, whatever that takes.
#if defined(__AVX512F__)
constexpr std::size_t kLaneBytes = 64;
#elif defined(__AVX__)
constexpr std::size_t kLaneBytes = 32;
#else
constexpr std::size_t kLaneBytes = 16;
#endif
using Lanes [[gnu::vector_size(kLaneBytes)]] = double;
using Eight [[gnu::vector_size(64)]] = double;
using AnyEight [[gnu::vector_size(64), gnu::aligned(8)]] = double;  // wherever they are
constexpr std::size_t kLanes = kLaneBytes / sizeof(double);
constexpr std::size_t kEight = kRowGranule;
static_assert(kEight == 8);

template <typename Vector>
Vector& at(double* p) {
  return *reinterpret_cast<Vector*>(p);
}
template <typename Vector>
const Vector& at(const double* p) {
  return *reinterpret_cast<const Vector*>(p);
}

// Not by the above: a template's argument forgets how its type is aligned.
inline AnyEight& any_eight(double* p) { return *reinterpret_cast<AnyEight*>(p); }
inline const AnyEight& any_eight(const double* p) { return *reinterpret_cast<const AnyEight*>(p); }

// a * b + c and c - a * b, rounded once whatever the instruction set: where it has no such
// operation, the library does the same slowly.
inline double fused(double a, double b, double c) { return __builtin_fma(a, b, c); }
inline double fused_less(double a, double b, double c) { return __builtin_fma(-a, b, c); }

// c <- a * b + c and c <- c - a * b of several values.
template <typename Vector>
inline void add_product(const Vector& a, const Vector& b, Vector& c) {
#if defined(__AVX512F__)
  c = _mm512_fmadd_pd(a, b, c);
#else
  for (std::size_t l = 0; l < sizeof(Vector) / sizeof(double); ++l) c[l] = fused(a[l], b[l], c[l]);
#endif
}
template <typename Vector>
inline void add_product(double a, const Vector& b, Vector& c) {
#if defined(__AVX512F__)
  c = _mm512_fmadd_pd(_mm512_set1_pd(a), b, c);
#elif defined(__FMA__)
  if constexpr (sizeof(Vector) == sizeof(__m256d))
    c = _mm256_fmadd_pd(_mm256_set1_pd(a), b, c);
  else
    add_product(Vector{} + a, b, c);
#else
  add_product(Vector{} + a, b, c);
#endif
}
template <typename Vector>
inline void subtract_product(double a, const Vector& b, Vector& c) {
#if defined(__AVX512F__)
  c = _mm512_fnmadd_pd(_mm512_set1_pd(a), b, c);
#elif defined(__FMA__)
  if constexpr (sizeof(Vector) == sizeof(__m256d))
    c = _mm256_fnmadd_pd(_mm256_set1_pd(a), b, c);
  else
    add_product(Vector{} - a, b, c);
#else
  add_product(Vector{} - a, b, c);
#endif
}

inline double without_noise(double entry, double magnitude) {
  return __builtin_fabs(entry) <= calibration::rounding::kNoise * magnitude ? 0.0 : entry;
}

// Rows whose heads are taken column after column: at most, and at least for that to pay.
constexpr int kAtOnce = 32;
constexpr int kFewRows = 4;

// With q = 1 / w, w' = w lambda d / d' reads q' = q + x_i^2 / (lambda d). A row that has given all
// its weight to a new direction (q infinite) has nothing left.
inline bool gives(double square, double inverse_row) {
  return square > 0.0 && inverse_row < __builtin_inf();
}

void eliminate_columns_of_heads(double* const* r, const RowBlock& x, const HeadBlock& head,
                                int first, int count) {
  const auto begin = static_cast<std::size_t>(first);
  const auto rows_here = static_cast<std::size_t>(count);
  double* rows = x.first + begin * x.stride;
  const double* magnitudes = head.magnitudes + begin * head.magnitude_stride;
  double* inverse_row = head.inverse_row_weights + begin;
  double entry[kAtOnce], row_weight[kAtOnce], taken[kAtOnce];
  double faded[kAtOnce], weights[kAtOnce], gain[kAtOnce], kept[kAtOnce];
  for (std::size_t a = 0; a < kEight; ++a) {
    for (std::size_t k = 0; k < rows_here; ++k)
      entry[k] = without_noise(rows[k * x.stride + a], magnitudes[k * head.magnitude_stride + a]);
    for (std::size_t k = 0; k < rows_here; ++k) {
      row_weight[k] = 1.0 / inverse_row[k];
      taken[k] = row_weight[k] * entry[k] * entry[k];
    }
    double weight = head.weights[a];
    for (std::size_t k = 0; k < rows_here; ++k) {
      faded[k] = head.lambda * weight;
      weight = fused(head.lambda, weight, taken[k]);
      weights[k] = weight;
    }
    head.weights[a] = weight;
    for (std::size_t k = 0; k < rows_here; ++k) {
      const double inverse = 1.0 / weights[k];
      const double square = entry[k] * entry[k];
      const double growth = square / faded[k];
      gain[k] = taken[k] > 0.0 ? row_weight[k] * entry[k] * inverse : 0.0;
      kept[k] = taken[k] > 0.0 ? faded[k] * inverse : 1.0;
      inverse_row[k] = gives(square, inverse_row[k]) ? inverse_row[k] + growth : inverse_row[k];
    }
    Eight stored = at<Eight>(r[a]);
    for (std::size_t k = 0; k < rows_here; ++k) {
      auto& row = at<Eight>(rows + k * x.stride);
      Eight mixed = gain[k] * row;
      subtract_product(entry[k], stored, row);
      add_product(kept[k], stored, mixed);
      stored = mixed;
    }
    at<Eight>(r[a]) = stored;
    for (std::size_t l = 0; l < a; ++l) r[a][l] = 0.0;  // what is left of the diagonal
    r[a][a] = 1.0;
    for (std::size_t k = 0; k < rows_here; ++k) {
      const std::size_t to = (begin + k) * kEight + a;
      head.entries[to] = entry[k];
      head.gains[to] = gain[k];
      head.kept[to] = kept[k];
    }
  }
}

void eliminate_head(double* const* r, const RowBlock& x, const HeadBlock& head, int k) {
  const auto s = static_cast<std::size_t>(k);
  double* row = x.first + s * x.stride;
  const double* magnitude = head.magnitudes + s * head.magnitude_stride;
  Eight left = at<Eight>(row);
  Eight lefts[kEight];
  Eight entry = {};
  Eight weight = {};
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a) {
    const double own = without_noise(left[a], magnitude[a]);
    entry[a] = own;
    lefts[a] = left;
    subtract_product(own, at<Eight>(r[a]), left);
    weight[a] = head.weights[a];
  }
  at<Eight>(row) = left;
  const Eight faded = head.lambda * weight;
  const Eight square = entry * entry;
  const Eight growth = square / faded;
  Eight inverse_row = {};
  double running = head.inverse_row_weights[k];
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a) {
    inverse_row[a] = running;
    running = gives(square[a], running) ? running + growth[a] : running;
  }
  head.inverse_row_weights[k] = running;
  const Eight row_weight = 1.0 / inverse_row;
  const Eight taken = row_weight * entry * entry;
  Eight now = taken;
  add_product(head.lambda, weight, now);
  const Eight inverse = 1.0 / now;
  const Eight gain = taken > 0.0 ? row_weight * entry * inverse : Eight{};
  const Eight kept = taken > 0.0 ? faded * inverse : Eight{} + 1.0;
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a) {
    Eight mixed = gain[a] * lefts[a];
    add_product(kept[a], at<Eight>(r[a]), mixed);
    at<Eight>(r[a]) = mixed;
    for (std::size_t l = 0; l < a; ++l) r[a][l] = 0.0;  // what is left of the diagonal
    r[a][a] = 1.0;
    head.weights[a] = now[a];
    head.entries[s * kEight + a] = entry[a];
    head.gains[s * kEight + a] = gain[a];
    head.kept[s * kEight + a] = kept[a];
  }
}

inline double total(const Eight& sum) {
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

template <std::size_t kColumns>
inline void reflect_columns(const double* v, double* columns, std::size_t stride, std::size_t count,
                            double factor, double* top) {
  Eight sum[kColumns] = {};
  for (std::size_t i = 0; i < count; i += kEight) {
    const Eight own = any_eight(v + i);
#pragma GCC unroll 4
    for (std::size_t c = 0; c < kColumns; ++c) sum[c] += own * any_eight(columns + c * stride + i);
  }
  double share[kColumns];
  for (std::size_t c = 0; c < kColumns; ++c) {
    share[c] = factor * (top[c] + total(sum[c]));
    top[c] -= share[c];
  }
  for (std::size_t i = 0; i < count; i += kEight) {
    const Eight own = any_eight(v + i);
#pragma GCC unroll 4
    for (std::size_t c = 0; c < kColumns; ++c) {
      any_eight(columns + c * stride + i) -= share[c] * own;
    }
  }
}

// Values of one sum that are taken side by side.
template <std::size_t kWide>
inline void subtract_past_of(const double* x, const double* coefficients, std::size_t order,
                             double* left) {
  Eight now[kWide];
#pragma GCC unroll 4
  for (std::size_t w = 0; w < kWide; ++w) now[w] = any_eight(x + w * kEight);
  for (std::size_t l = 0; l < order; ++l) {
    const double* past = x - (l + 1);
#pragma GCC unroll 4
    for (std::size_t w = 0; w < kWide; ++w)
      now[w] -= coefficients[l] * any_eight(past + w * kEight);
  }
#pragma GCC unroll 4
  for (std::size_t w = 0; w < kWide; ++w) any_eight(left + w * kEight) = now[w];
}

// Registers of columns that are taken side by side: what they wait for, others fill, and the
// stored values of all stay in registers.
#if defined(__AVX512F__)
constexpr std::size_t kAbreast = 2;
#else
constexpr std::size_t kAbreast = 1;
#endif

template <std::size_t kColumns>
inline void eliminate_columns(double* const* r, const RowBlock& x, std::size_t c,
                              const double* entry, const double* gain) {
  Lanes stored[kEight][kColumns];
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a)
    for (std::size_t b = 0; b < kColumns; ++b) stored[a][b] = at<Lanes>(r[a] + c + b * kLanes);
  double* row = x.first + c;
  for (int k = 0; k < x.rows; ++k, row += x.stride, entry += kEight, gain += kEight) {
    Lanes left[kColumns];
    for (std::size_t b = 0; b < kColumns; ++b) left[b] = at<Lanes>(row + b * kLanes);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kEight; ++a) {
      for (std::size_t b = 0; b < kColumns; ++b) subtract_product(entry[a], stored[a][b], left[b]);
      for (std::size_t b = 0; b < kColumns; ++b) add_product(gain[a], left[b], stored[a][b]);
    }
    for (std::size_t b = 0; b < kColumns; ++b) at<Lanes>(row + b * kLanes) = left[b];
  }
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a)
    for (std::size_t b = 0; b < kColumns; ++b) at<Lanes>(r[a] + c + b * kLanes) = stored[a][b];
}

// What is stored comes and goes; the row's coefficients stay in registers.
inline void eliminate_one(double* const* r, double* x, std::size_t count, const double* entries,
                          const double* gains) {
  double* stored[kEight];
  double entry[kEight], gain[kEight];
  for (std::size_t a = 0; a < kEight; ++a) {
    stored[a] = r[a];
    entry[a] = entries[a];
    gain[a] = gains[a];
  }
  for (std::size_t c = 0; c < count; c += kLanes) {
    Lanes left = at<Lanes>(x + c);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kEight; ++a) {
      Lanes own = at<Lanes>(stored[a] + c);
      subtract_product(entry[a], own, left);
      add_product(gain[a], left, own);
      at<Lanes>(stored[a] + c) = own;
    }
    at<Lanes>(x + c) = left;
  }
}

inline void project_one(const double* const* r, double* x, std::size_t count,
                        const double* entries) {
  const double* stored[kEight];
  double entry[kEight];
  for (std::size_t a = 0; a < kEight; ++a) {
    stored[a] = r[a];
    entry[a] = entries[a];
  }
  for (std::size_t c = 0; c < count; c += kLanes) {
    Lanes left = at<Lanes>(x + c);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kEight; ++a)
      subtract_product(entry[a], at<Lanes>(stored[a] + c), left);
    at<Lanes>(x + c) = left;
  }
}

template <std::size_t kColumns>
inline void project_columns(const double* const* r, const RowBlock& x, std::size_t c,
                            const double* entry) {
  Lanes stored[kEight][kColumns];
#pragma GCC unroll 8
  for (std::size_t a = 0; a < kEight; ++a)
    for (std::size_t b = 0; b < kColumns; ++b) stored[a][b] = at<Lanes>(r[a] + c + b * kLanes);
  double* row = x.first + c;
  for (int k = 0; k < x.rows; ++k, row += x.stride, entry += kEight) {
    Lanes left[kColumns];
    for (std::size_t b = 0; b < kColumns; ++b) left[b] = at<Lanes>(row + b * kLanes);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kEight; ++a)
      for (std::size_t b = 0; b < kColumns; ++b) subtract_product(entry[a], stored[a][b], left[b]);
    for (std::size_t b = 0; b < kColumns; ++b) at<Lanes>(row + b * kLanes) = left[b];
  }
}

}  // namespace

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
    const double left = fused_less(entry, r[i], x[i]);
    r[i] = fused(gain, left, r[i]);
    x[i] = left;
  }
}

void blend_row(double* __restrict r, double* __restrict x, std::size_t count, double entry,
               double gain, double kept) {
  for (std::size_t i = 0; i < count; ++i) {
    const double old_x = x[i];
    x[i] = fused_less(entry, r[i], old_x);
    r[i] = fused(kept, r[i], gain * old_x);
  }
}

void project_row(const double* __restrict r, double* __restrict x, std::size_t count,
                 double entry) {
  for (std::size_t i = 0; i < count; ++i) x[i] = fused_less(entry, r[i], x[i]);
}

// Many rows column after column: a row's entry in a column does not depend on what rows before it
// did there. Few rows one after the other, all columns at a time. The bits are the same.
void eliminate_heads(double* const* r, const RowBlock& x, const HeadBlock& head) {
  int k = 0;
  for (; k + kFewRows <= x.rows; k += kAtOnce) {
    const int left = x.rows - k;
    eliminate_columns_of_heads(r, x, head, k, left < kAtOnce ? left : kAtOnce);
  }
  for (; k < x.rows; ++k) eliminate_head(r, x, head, k);
}

void eliminate_block(double* const* r, const RowBlock& x, std::size_t count, const double* entries,
                     const double* gains) {
  if (x.rows < kFewRows) {
    for (int k = 0; k < x.rows; ++k, entries += kEight, gains += kEight)
      eliminate_one(r, x.first + static_cast<std::size_t>(k) * x.stride, count, entries, gains);
    return;
  }
  std::size_t c = 0;
  for (; c + kAbreast * kLanes <= count; c += kAbreast * kLanes)
    eliminate_columns<kAbreast>(r, x, c, entries, gains);
  for (; c < count; c += kLanes) eliminate_columns<1>(r, x, c, entries, gains);
}

void project_heads(const double* const* r, const RowBlock& x, const double* magnitudes,
                   double* entries) {
  Eight stored[kEight];
  for (std::size_t a = 0; a < kEight; ++a) stored[a] = at<Eight>(r[a]);
  double* row = x.first;
  for (int k = 0; k < x.rows; ++k, row += x.stride, entries += kEight) {
    Eight left = at<Eight>(row);
#pragma GCC unroll 8
    for (std::size_t a = 0; a < kEight; ++a) {
      entries[a] = without_noise(left[a], magnitudes[a]);
      subtract_product(entries[a], stored[a], left);
    }
    at<Eight>(row) = left;
  }
}

void project_block(const double* const* r, const RowBlock& x, std::size_t count,
                   const double* entries) {
  if (x.rows < kFewRows) {
    for (int k = 0; k < x.rows; ++k, entries += kEight)
      project_one(r, x.first + static_cast<std::size_t>(k) * x.stride, count, entries);
    return;
  }
  std::size_t c = 0;
  for (; c + kAbreast * kLanes <= count; c += kAbreast * kLanes)
    project_columns<kAbreast>(r, x, c, entries);
  for (; c < count; c += kLanes) project_columns<1>(r, x, c, entries);
}

// Summed in eight lanes whatever the instruction set, so the bits are the same; four rows at a
// time, whose additions need not wait for each other.
void inner_products(const double* a, const RowBlock& x, std::size_t count, double* products) {
  int k = 0;
  for (; k + 4 <= x.rows; k += 4) {
    const double* row = x.first + static_cast<std::size_t>(k) * x.stride;
    Eight sum0 = {}, sum1 = {}, sum2 = {}, sum3 = {};
    for (std::size_t c = 0; c < count; c += kEight, row += kEight) {
      const Eight other = at<Eight>(a + c);
      add_product(other, at<Eight>(row), sum0);
      add_product(other, at<Eight>(row + x.stride), sum1);
      add_product(other, at<Eight>(row + 2 * x.stride), sum2);
      add_product(other, at<Eight>(row + 3 * x.stride), sum3);
    }
    products[k] = total(sum0);
    products[k + 1] = total(sum1);
    products[k + 2] = total(sum2);
    products[k + 3] = total(sum3);
  }
  for (; k < x.rows; ++k) {
    const double* row = x.first + static_cast<std::size_t>(k) * x.stride;
    Eight sum = {};
    for (std::size_t c = 0; c < count; c += kEight)
      add_product(at<Eight>(a + c), at<Eight>(row + c), sum);
    products[k] = total(sum);
  }
}

void reflect(const double* v, const RowBlock& x, std::size_t count, double factor, double* top) {
  constexpr int kTogether = kLaneBytes > 16 ? 4 : 1;
  int k = 0;
  for (; k + kTogether <= x.rows; k += kTogether)
    reflect_columns<kTogether>(v, x.first + static_cast<std::size_t>(k) * x.stride, x.stride, count,
                               factor, top + k);
  for (; k < x.rows; ++k)
    reflect_columns<1>(v, x.first + static_cast<std::size_t>(k) * x.stride, x.stride, count, factor,
                       top + k);
}

void subtract_past(const double* x, std::size_t count, const double* coefficients,
                   std::size_t order, double* left) {
  constexpr std::size_t kWide = kLaneBytes > 16 ? 4 : 2;
  std::size_t k = order;
  for (; k + kWide * kEight <= count; k += kWide * kEight)
    subtract_past_of<kWide>(x + k, coefficients, order, left + k);
  for (; k < count; ++k) {
    double now = x[k];
    for (std::size_t l = 0; l < order; ++l) now -= coefficients[l] * x[k - l - 1];
    left[k] = now;
  }
}

}  // namespace mpm::MPM_KERNEL_SET
