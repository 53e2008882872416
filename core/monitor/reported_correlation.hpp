#pragma once

#include <Eigen/Core>

#include "core/mismatch/lagged_correlation.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/unit_inputs.hpp"
#include "core/monitor/unit_residuals.hpp"
#include "core/signal/frame.hpp"

namespace mpm {

/// Where a channel's correlation is largest in magnitude among the lags that feedback does not
/// reach (>= 1).
struct CorrelationPeak {
  double value = 0.0;
  int lag = 0;  ///< samples
};

/// The correlations of all channels, of the kind that the settings name. Rows that wait for each
/// other cost a fraction, so they are only brought up to date by `evaluate`.
class ReportedCorrelation {
 public:
  ReportedCorrelation(const SignalCounts& counts, const DerivedSettings& settings);

  /// Takes a sample; where a value has been unknown for long, the rows break off.
  void take(const UnitInputs& inputs, const UnitResiduals& residuals);
  /// The samples so far and the next one are not neighbours.
  void close_window() { correlation_.close_window(); }

  /// As of the last sample; nothing happens where it was done already.
  void evaluate();
  /// Of the last `evaluate`:
  [[nodiscard]] CorrelationPeak peak(int cv, int input) const;
  [[nodiscard]] double mean_line() const;
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> values(int cv, int input) const {
    return correlation_.correlations(cv, input);
  }

  template <class Archive>
  void archive(Archive& a) {
    // not archived: first_lag_ (construction)
    a(correlation_, current_);
  }

 private:
  int first_lag_;
  LaggedCorrelation correlation_;
  bool current_ = false;  // knows the last sample
};

}  // namespace mpm
