#pragma once

#include <Eigen/Core>
#include <variant>

#include "core/mismatch/lagged_correlation.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/monitor/unit_inputs.hpp"
#include "core/monitor/unit_residuals.hpp"
#include "core/nonlinear/rank_correlation.hpp"
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
  void close_window() {
    std::visit([](auto& correlation) { correlation.close_window(); }, correlation_);
  }

  /// As of the last sample; nothing happens where it was done already.
  void evaluate();
  /// Of the last `evaluate`:
  [[nodiscard]] CorrelationPeak peak(int cv, int input) const;
  /// Of correlations that are not of ranks (`LaggedCorrelation`).
  [[nodiscard]] double mean_line() const;
  [[nodiscard]] Eigen::Ref<const Eigen::VectorXd> values(int cv, int input) const {
    return std::visit([&](const auto& correlation) { return correlation.correlations(cv, input); },
                      correlation_);
  }

  template <class Archive>
  void archive(Archive& a) {
    // not archived: first_lag_, last_lag_ (construction)
    std::visit([&a](auto& correlation) { correlation.archive(a); }, correlation_);
    a(current_);
  }

 private:
  int first_lag_, last_lag_;
  std::variant<LaggedCorrelation, RankCorrelation> correlation_;
  bool current_ = false;  // knows the last sample
};

}  // namespace mpm
