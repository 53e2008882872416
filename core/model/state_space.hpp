#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/model/channel_facts.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Spectral split of a discrete state matrix at its eigenvalue 1.
struct StateSpaceFacts {
  Eigen::MatrixXd rest;  ///< states per unit of each held input, integrating parts at rest
  Eigen::MatrixXd gain;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating;
  double slowest = 1.0;
  bool unstable = false;
};

/// Throws std::invalid_argument where sizes do not match or an entry is not finite.
void check_state_space(const StateSpaceSpec& system, int inputs, int cvs);

[[nodiscard]] StateSpaceFacts analyse_state_space(const StateSpaceSpec& system);

/// What is known of each channel, outputs x inputs, row by row.
[[nodiscard]] std::vector<ChannelFacts> channel_facts(const StateSpaceSpec& system,
                                                      const StateSpaceFacts& facts);

}  // namespace mpm
