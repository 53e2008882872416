#pragma once

#include <Eigen/Core>

#include "core/model/channel_facts.hpp"
#include "core/model/input_history.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// A step response: y(k+1) = sum_j weights(j) u(k-(last-j)), oldest first.
struct FirChannel {
  int cv, source;  ///< source: row of the input history
  Eigen::VectorXd weights;

  /// Input values that it looks back on.
  [[nodiscard]] int history() const { return static_cast<int>(weights.size()); }
  [[nodiscard]] double output(const InputHistory& inputs) const {
    const Eigen::Index length = weights.size();
    const Eigen::Map<const Eigen::VectorXd> window(inputs.newest(source) - (length - 1), length);
    return weights.dot(window);
  }
};

struct DescribedFir {
  FirChannel channel;
  ChannelFacts facts;
};
/// Throws std::invalid_argument where values are missing or not finite.
[[nodiscard]] DescribedFir make_fir_channel(int cv, int source, const StepResponse& response);

}  // namespace mpm
