#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// What an engineer expects of a channel, simplest first.
enum class ChannelForm {
  kFirstOrder,       ///< K e^{-Ls} / (T s + 1)
  kSecondOrder,      ///< K e^{-Ls} / ((T s + 1)(T2 s + 1))
  kDamped,           ///< K e^{-Ls} / (T^2 s^2 + 2 damping T s + 1), damping < 1
  kSecondOrderLead,  ///< K (lead s + 1) e^{-Ls} / ((T s + 1)(T2 s + 1))
  kThirdOrderLead,   ///< K (lead s + 1) e^{-Ls} / ((T s + 1)(T2 s + 1)(T3 s + 1))
  kIntegrator,       ///< K e^{-Ls} / s
  kIntegratorLag,    ///< K e^{-Ls} / (s (T s + 1))
};

/// One channel of a model that is being fitted: times in samples, gain in CV units per input unit
/// (of an integrator: and sample).
struct ChannelShape {
  int input = 0;
  ChannelForm form = ChannelForm::kFirstOrder;
  double gain = 0.0;
  double dead_time = 0.0;
  double time_constant = 1.0;
  double second = 1.0;
  double third = 1.0;
  double lead = 0.0;
  double damping = 0.5;
  bool dead_time_known = false;  ///< the user gave it: it stays
  int sign = 0;                  ///< of the gain, where the user gave it; else 0
  bool may_integrate = true;     ///< the user has not said that it does not
};

[[nodiscard]] bool integrates(ChannelForm form);
/// Its lags, samples; of a damped pair none.
[[nodiscard]] std::vector<double> lags(const ChannelShape& shape);

/// A number of a shape that a fit moves. Times are moved by their log.
enum class ShapeNumber { kGain, kDeadTime, kLogTime, kLogSecond, kLogThird, kLead, kDamping };
[[nodiscard]] std::vector<ShapeNumber> free_numbers(const ChannelShape& shape);
[[nodiscard]] double number_of(const ChannelShape& shape, ShapeNumber which);
/// Within what makes sense: dead time and lags not negative, `longest` (samples) at most.
void set_number(ChannelShape& shape, ShapeNumber which, double value, double longest);

/// How long the slowest of what a change leaves takes to fall to 1/e, samples.
[[nodiscard]] double slowest_time(const ChannelShape& shape);

/// Of a damped pair all but the pair. With times in units of `sample_time_s`: 1 for samples.
[[nodiscard]] TransferFunction transfer_function(const ChannelShape& shape, double sample_time_s);

/// What the channel gives from an input (deviations), each run from rest at its first value; an
/// integrator from 0.
[[nodiscard]] Eigen::VectorXd response(const ChannelShape& shape,
                                       const Eigen::Ref<const Eigen::VectorXd>& input,
                                       const std::vector<Run>& runs);

}  // namespace mpm
