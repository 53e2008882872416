#pragma once

#include <span>
#include <vector>

#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/regression_history.hpp"
#include "core/mismatch/regression_memory.hpp"
#include "core/regression/givens_qr.hpp"
#include "core/regression/row_feed.hpp"

namespace mpm {

/// On which other CVs' residuals that of a CV rests: what disturbs one CV often disturbs others, or
/// reaches them through it. Read off the CV's own regression, which has the inputs beside them. No
/// allocation after construction.
class CoupledCvs {
 public:
  explicit CoupledCvs(const RegressionShape& shape);

  struct Other {
    int cv = 0;
    double p_value = 1.0;  ///< of its residual saying nothing of this CV's next one
  };
  /// Those on which it rests most surely (p < `calibration::coupled_errors::kUncoupledPValue`), the
  /// surest first, less than `calibration::coupled_errors::kMostCvs`. `memories`: of all CVs, null
  /// of those that do not count. Valid until the next call.
  [[nodiscard]] std::span<const Other> of(int cv,
                                          std::span<const RegressionMemory* const> memories);

  /// Of one of them.
  [[nodiscard]] double p_value(const GivensQr& factor, const EstimateNoise& noise, int other);

 private:
  RegressionShape shape_;
  int lead_in_;  // the most columns
  RowFeed feed_;
  GivensQr lags_;  // [lead-in, the lags of one CV last | response]
  std::vector<Other> found_;
};

}  // namespace mpm
