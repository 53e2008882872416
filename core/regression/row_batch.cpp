#include "core/regression/row_batch.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

namespace mpm {

void AlignedDelete::operator()(double* p) const {
  ::operator delete[](p, std::align_val_t{kRowAlignment});
}

AlignedArray make_aligned(std::size_t count) {
  AlignedArray array(static_cast<double*>(
      ::operator new[](count * sizeof(double), std::align_val_t{kRowAlignment})));
  std::fill_n(array.get(), count, 0.0);
  return array;
}

RowBatch::RowBatch(int values, int capacity) : capacity_(capacity) {
  if (values <= 0 || capacity <= 0) throw std::invalid_argument("a batch of no rows");
  const auto rows = static_cast<std::size_t>(capacity);
  stride_ = (static_cast<std::size_t>(values) + kRowGranule - 1) / kRowGranule * kRowGranule;
  rows_ = make_aligned(rows * stride_);
  magnitudes_ = make_aligned(rows * stride_);
  inverse_row_weights_ = make_aligned(rows);
  entries_ = make_aligned(rows * kRowGranule);
  gains_ = make_aligned(rows * kRowGranule);
  kept_ = make_aligned(rows * kRowGranule);
}

}  // namespace mpm
