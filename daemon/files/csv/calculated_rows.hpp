#pragma once

#include <memory>
#include <utility>

#include "daemon/files/calculator.hpp"
#include "daemon/files/csv/row_source.hpp"

namespace mpm::files {

/// Rows with their calculated signals: computed row by row, before anything is averaged, so that a
/// product is the mean of products.
class CalculatedRows : public RowSource {
 public:
  CalculatedRows(std::unique_ptr<RowSource> rows, const config::UnitConfig& unit)
      : rows_(std::move(rows)), calculator_(unit) {}

  [[nodiscard]] bool next(Frame& frame) override {
    if (!rows_->next(frame)) return false;
    calculator_.fill(frame);
    return true;
  }

 private:
  std::unique_ptr<RowSource> rows_;
  Calculator calculator_;
};

}  // namespace mpm::files
