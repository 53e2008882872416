#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/model/channel_facts.hpp"
#include "core/model/input_history.hpp"
#include "core/model/model_spec.hpp"
#include "core/model/zero_order_hold.hpp"

namespace mpm {

/// A sampled transfer function: x(k+1) = Phi x(k) + ..., see SampledLag. `states` is the common
/// state vector of all channels.
struct LagChannel {
  int cv, source;  ///< source: row of the input history
  SampledLag sampled;
  Eigen::VectorXd rest;      ///< states per unit of an input held for ever, integrator at 0
  Eigen::Index first_state;  ///< in the common state vector

  /// Input values that it looks back on.
  [[nodiscard]] int history() const { return sampled.delay + 2; }
  void step(const InputHistory& inputs, Eigen::VectorXd& states) const;
  [[nodiscard]] double output(const InputHistory& inputs, const Eigen::VectorXd& states) const;
};

[[nodiscard]] LagChannel make_lag_channel(int cv, int source, const TransferFunction& transfer,
                                          double sample_time_s, Eigen::Index first_state);
[[nodiscard]] ChannelFacts facts_of(const LagChannel& lag, const TransferFunction& transfer,
                                    double sample_time_s);

inline void LagChannel::step(const InputHistory& inputs, Eigen::VectorXd& states) const {
  const Eigen::Index order = sampled.output.size();
  const double newer = inputs.newest(source)[-sampled.delay];
  const double older = inputs.newest(source)[-sampled.delay - 1];
  double* x = states.data() + first_state;
  // Lower triangular, so the rows are taken from the last one and no copy is needed.
  for (Eigen::Index i = order; i-- > 0;) {
    double value = sampled.from_newer(i) * newer + sampled.from_older(i) * older;
    for (Eigen::Index j = 0; j <= i; ++j) value += sampled.transition(i, j) * x[j];
    x[i] = value;
  }
}

inline double LagChannel::output(const InputHistory& inputs, const Eigen::VectorXd& states) const {
  const Eigen::Index order = sampled.output.size();
  double value = sampled.feed_through * inputs.newest(source)[-sampled.delay];
  for (Eigen::Index i = std::max<Eigen::Index>(0, order - 2); i < order; ++i)
    value += sampled.output(i) * states(first_state + i);
  return value;
}

}  // namespace mpm
