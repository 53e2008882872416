#pragma once

#include <memory>
#include <utility>

#include "daemon/files/csv/row_source.hpp"
#include "daemon/files/unit_rules.hpp"

namespace mpm::files {

/// Rows with their calculated signals, and without what inputs cannot be: row by row, before
/// anything is averaged, so that a product is the mean of products.
class PreparedRows : public RowSource {
 public:
  PreparedRows(std::unique_ptr<RowSource> rows, const config::UnitConfig& unit, Purpose purpose)
      : rows_(std::move(rows)), rules_(unit, purpose) {}

  [[nodiscard]] bool next(Frame& frame) override {
    if (!rows_->next(frame)) return false;
    rules_.apply(frame);
    return true;
  }

 private:
  std::unique_ptr<RowSource> rows_;
  UnitRules rules_;
};

}  // namespace mpm::files
