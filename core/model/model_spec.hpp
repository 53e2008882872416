#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

/// The controller's internal model ("the simulation") as plain data, exactly as a unit file says
/// it. `LinearModel` turns it into a simulator. Inputs are numbered MVs first, then DVs.
namespace mpm {

/// gain (lead s + 1) e^{-dead_time s} / [s] prod (T s + 1). `integrating` adds the 1/s; the gain
/// is then CV units per input unit and second.
struct TransferFunction {
  double gain = 1.0;                     ///< CV units per input unit
  std::vector<double> time_constants_s;  ///< each > 0; empty = pure gain and dead time
  double lead_s = 0.0;
  double dead_time_s = 0.0;  ///< >= 0, any fraction of the sample time
  bool integrating = false;
};

/// z-domain: sum numerator[i] z^-i / sum denominator[i] z^-i, after delay_samples more steps.
/// denominator[0] != 0. As in all sampled rows here, y(k) sees u(k-1) at the earliest, so the
/// numerator's first coefficient with delay_samples = 0 acts one sample after u was applied.
struct DiscreteFilter {
  std::vector<double> numerator;
  std::vector<double> denominator;
  int delay_samples = 0;
};

/// Response to a unit step at u(0): values[l] = y(l), holds its last value.
struct StepResponse {
  std::vector<double> values;
};

struct ChannelSpec {
  int cv = 0;
  int input = 0;
  std::variant<TransferFunction, DiscreteFilter, StepResponse> dynamics;
};

/// x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k-1), discrete at the sample time.
struct StateSpaceSpec {
  Eigen::MatrixXd a, b, c, d;
  Eigen::VectorXd x0;  ///< empty = at rest
};

/// Static blocks, applied to the deviation-free signal in its own units.
struct Polynomial {
  std::vector<double> coefficients;  ///< c1 u + c2 u^2 + ... of the deviation from the origin
};
struct Saturation {
  double low = 0.0;
  double high = 0.0;
};
struct Deadband {
  double width = 0.0;  ///< play: the output follows only after the input has moved by this much
};
struct Stiction {
  double band = 0.0;  ///< S: the valve sticks until its command has moved this far
  double jump = 0.0;  ///< J: then it slips by this much (Choudhury 2005)
};
struct Offset {
  double bias = 0.0;
};
struct Scale {
  double factor = 1.0;  ///< of the deviation from the origin
};
using InputBlock = std::variant<Polynomial, Saturation, Deadband, Stiction>;
using OutputBlock = std::variant<Saturation, Offset, Scale>;

struct ModelSpec {
  double sample_time_s = 1.0;
  int input_count = 0;  ///< MVs, then DVs
  int cv_count = 0;
  std::vector<ChannelSpec> channels;          ///< at most one per (cv, input); none = no relation
  std::optional<StateSpaceSpec> state_space;  ///< instead of channels
  std::vector<std::optional<InputBlock>> input_blocks;    ///< one per input
  std::vector<std::optional<OutputBlock>> output_blocks;  ///< one per CV
  Eigen::VectorXd input_origin;                           ///< operating point of the inputs
  Eigen::VectorXd output_origin;                          ///< operating point of the CVs
};

}  // namespace mpm
