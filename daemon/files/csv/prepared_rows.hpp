#pragma once

#include <memory>
#include <utility>

#include "daemon/files/calculator.hpp"
#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/input_ranges.hpp"

namespace mpm::files {

/// Rows with their calculated signals, and without what inputs cannot be: row by row, before
/// anything is averaged, so that a product is the mean of products.
class PreparedRows : public RowSource {
 public:
  PreparedRows(std::unique_ptr<RowSource> rows, const config::UnitConfig& unit, Purpose purpose)
      : rows_(std::move(rows)), calculator_(unit), ranges_(unit, purpose) {}

  [[nodiscard]] bool next(Frame& frame) override {
    if (!rows_->next(frame)) return false;
    calculator_.fill(frame);
    ranges_.mark(frame);
    return true;
  }

 private:
  std::unique_ptr<RowSource> rows_;
  Calculator calculator_;
  InputRanges ranges_;
};

}  // namespace mpm::files
