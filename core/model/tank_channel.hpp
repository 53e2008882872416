#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/model/channel_facts.hpp"
#include "core/model/input_history.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// One tank of a chain: (T / 2) dh/dt = inflow - sqrt(h), 0 <= h <= overflow.
struct Tank {
  double time_constant_s;
  double overflow;
  double spill;

  /// Three-stage diagonally implicit Runge-Kutta step of order 3 (Alexander 1977), stiffly accurate
  /// and L-stable: near an empty tank, where the slope of the root has no bound, an explicit step
  /// would swing. Each stage is a quadratic in sqrt(h) and has a closed form. `flow` is what flows
  /// in at the stages, then what this tank passes on.
  using StageFlow = std::array<double, 3>;
  [[nodiscard]] double step(double level, double step_s, StageFlow& flow) const;
  /// The level at which `flow` in and out agree; `flow` becomes what this tank passes on.
  [[nodiscard]] double rest(double& flow) const;
};

/// A `TankChain` under a zero-order hold; its states in the common state vector are the levels.
/// A dead time of delay + fraction samples splits the hold in two, as in `SampledLag`.
struct TankChannel {
  int cv, source;  ///< source: row of the input history
  std::vector<Tank> tanks;
  double input_span;   ///< of the deviation, for the whole flow of the operating point
  double output_span;  ///< CV units per relative level
  int delay;           ///< whole samples
  struct Piece {
    double duration_s;
    int steps;
  };
  Piece older, newer;  ///< parts of a sample under the older and the newer input
  Eigen::Index first_state;

  /// Input values that it looks back on.
  [[nodiscard]] int history() const { return delay + 2; }
  void step(const InputHistory& inputs, Eigen::VectorXd& states) const;
  /// As if the newest input had been held for ever.
  void rest(const InputHistory& inputs, Eigen::VectorXd& states) const;
  [[nodiscard]] double output(const Eigen::VectorXd& states) const {
    return output_span * (states(first_state + static_cast<Eigen::Index>(tanks.size()) - 1) - 1.0);
  }

 private:
  [[nodiscard]] double inflow(double deviation) const;
  void pass(double inflow, const Piece& piece, double* levels) const;
};

struct DescribedTanks {
  TankChannel channel;
  ChannelFacts facts;
};
/// Throws std::invalid_argument where the parameters make no sense at this operating point.
[[nodiscard]] DescribedTanks make_tank_channel(int cv, int source, const TankChain& tanks,
                                               double input_origin, double output_origin,
                                               double sample_time_s, Eigen::Index first_state);

/// What the chain is for small movements around the operating point.
[[nodiscard]] TransferFunction linearised(const TankChain& tanks, double input_origin,
                                          double output_origin);

}  // namespace mpm
