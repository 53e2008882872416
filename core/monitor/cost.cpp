#include "core/monitor/cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/coupled_errors.hpp"
#include "core/mismatch/signature.hpp"
#include "core/model/linear_model.hpp"
#include "core/monitor/calibration.hpp"
#include "core/monitor/derived_settings.hpp"
#include "core/nonlinear/linear_companions.hpp"
#include "core/nonlinear/nonlinear_terms.hpp"

namespace mpm {
namespace {

using calibration::cost::kPerFitted;
using calibration::cost::kPerInverted;
using calibration::cost::kPerRanked;
using calibration::cost::kPerRotated;

constexpr double kNumber = sizeof(double);
constexpr double kRank = sizeof(std::int32_t);
constexpr double kTwice = 2.0;        // a lag window holds each value so often
constexpr double kPerCv = 2.0 + 2.0;  // residual and weight, share and scale

}  // namespace

MonitorCost monitor_cost(const ModelSpec& spec, const MonitorSettings& settings) {
  const DerivedSettings derived = derive_settings(spec, LinearModel(spec), settings, {});
  const double inputs = spec.input_count, cvs = spec.cv_count;
  const auto tails = static_cast<double>(derived.tail_poles.size());
  const double block = derived.fir_lags + tails;
  const auto memories = static_cast<double>(derived.memories.size());
  MonitorCost cost;
  cost.columns = 1.0 + cvs * derived.residual_order +
                 static_cast<double>(derived.residual_poles.size()) + inputs * block;
  cost.remembered = derived.remembered;
  const auto means = static_cast<double>(derived.outside_poles.size());  // of set-points
  const double history =
      kTwice * cost.remembered * (inputs * (1.0 + tails) + (kPerCv + 1.0 + means) * cvs);
  const double factors = cvs * memories * cost.columns * cost.columns;
  const double evaluation = std::pow(inputs * block, 2);
  const double own = inputs * (derived.controlling_lags + 1.0);  // of the reported correlations
  const double responses = cvs * (derived.last_lag - derived.first_lag + 1.0);
  const double tree = (1.0 + std::log2(inputs)) * own * (0.5 * own + responses);
  const double lags = BlockBasis::lags_beyond(derived.tail_poles);
  const double shapes = kTwice * inputs * cvs * lags;
  const double terms = NonlinearTerms::columns_of(derived.nonlinear, spec.input_count);
  const RegressionShape shape{spec.input_count,
                              spec.cv_count,
                              derived.fir_lags,
                              derived.residual_order,
                              derived.tail_poles,
                              {},
                              0,
                              derived.residual_poles};
  const double beside =
      terms > 0.0 ? cost.columns + LinearCompanions(shape, 1).columns() + terms : 0.0;
  const double nonlinear = cvs * beside * beside;
  // Before and after each moment of a change, with and without the inputs (`ChangeScan`).
  const double led = 1.0 + cvs * derived.residual_order +
                     static_cast<double>(derived.residual_poles.size()) +
                     static_cast<double>(calibration::simulation::kStartPoles.size());
  const double scan = kTwice * kTwice * calibration::change_scan::kMoments * led * (led + 1.0);
  const bool ranked = of_ranks(derived.correlation);
  const double ranks = (inputs + responses) * derived.ranked;
  const double correlated = ranked ? (1.0 + kRank / kNumber) * ranks : tree;
  cost.bytes =
      kNumber * (history + factors + nonlinear + 2.0 * cvs * terms * terms + 2.0 * evaluation +
                 correlated + shapes + scan + kTwice * CoupledErrors::numbers_of(shape));
  cost.seconds =
      kPerRotated * (factors + nonlinear) + (ranked ? kPerRanked * ranks : kPerRotated * tree) +
      kPerInverted * cvs * (memories * std::pow(inputs * block, 3) + std::pow(terms, 3)) /
          derived.evaluation_stride;
  const double past =
      2.0 + derived.residual_order + static_cast<double>(derived.residual_poles.size());
  const int together = CoupledErrors::most_cvs(shape);
  // Of all turns that may be taken half are, if all CVs are judged together; measured on units of
  // three by three to ten by twenty (docs/validation.md, speed).
  const double coupled = together > 1 ? 0.5 * calibration::coupled_errors::kTurns *
                                            CoupledErrors::work_of(shape, together)
                                      : 0.0;
  cost.seconds_alarmed =
      cost.seconds +
      cvs * memories *
          (kPerFitted * (derived.fir_lags + lags) * past * (2.0 + tails) + kPerRotated * coupled) /
          derived.evaluation_stride;
  return cost;
}

}  // namespace mpm
