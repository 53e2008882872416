#pragma once

#include <Eigen/Core>

#include "core/model/channel_facts.hpp"
#include "core/model/input_history.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// A z-domain filter: y(k+1) = b0 u(k-delay) + z1(k), z_i(k+1) = b_i u(k-delay) + z_{i+1}(k) -
/// a_i y(k+1), the transposed direct form, states (y, z1 .. zn) in the common state vector.
struct FilterChannel {
  int cv, source, delay;                   ///< source: row of the input history
  Eigen::VectorXd numerator, denominator;  ///< n+1 coefficients each, denominator(0) = 1
  Eigen::VectorXd rest;                    ///< states per unit of an input held for ever
  Eigen::Index first_state;

  /// Input values that it looks back on.
  [[nodiscard]] int history() const { return delay + 1; }
  void step(const InputHistory& inputs, Eigen::VectorXd& states) const;
  [[nodiscard]] double output(const Eigen::VectorXd& states) const { return states(first_state); }
};

/// A filter and what is known of it, which its state at rest follows from.
struct DescribedFilter {
  FilterChannel channel;
  ChannelFacts facts;
};
/// Throws std::invalid_argument where the coefficients or the delay make no sense.
[[nodiscard]] DescribedFilter make_filter_channel(int cv, int source, const DiscreteFilter& filter,
                                                  Eigen::Index first_state);

inline void FilterChannel::step(const InputHistory& inputs, Eigen::VectorXd& states) const {
  const double u = inputs.newest(source)[-delay];
  double* z = states.data() + first_state;
  const Eigen::Index order = numerator.size() - 1;
  const double y = numerator(0) * u + (order > 0 ? z[1] : 0.0);
  z[0] = y;
  for (Eigen::Index i = 1; i <= order; ++i)
    z[i] = numerator(i) * u - denominator(i) * y + (i < order ? z[i + 1] : 0.0);
}

}  // namespace mpm
