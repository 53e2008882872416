#include "core/model/lag_channel.hpp"

namespace mpm {

LagChannel make_lag_channel(int cv, int source, const TransferFunction& transfer,
                            double sample_time_s, Eigen::Index first_state) {
  LagChannel lag{cv, source, sample_transfer_function(transfer, sample_time_s), {}, first_state};
  const Eigen::Index order = lag.sampled.output.size();
  lag.rest = Eigen::VectorXd::Ones(order);
  if (transfer.integrating) lag.rest(order - 1) = 0.0;
  return lag;
}

ChannelFacts facts_of(const LagChannel& lag, const TransferFunction& transfer,
                      double sample_time_s) {
  ChannelFacts result;
  result.integrating = transfer.integrating;
  result.gain = transfer.gain * (transfer.integrating ? sample_time_s : 1.0);
  result.dead_time = transfer.dead_time_s / sample_time_s;
  result.order = lag.sampled.output.size();
  for (const double time_constant_s : transfer.time_constants_s)
    result.slowest = std::max(result.slowest, time_constant_s / sample_time_s);
  return result;
}

}  // namespace mpm
