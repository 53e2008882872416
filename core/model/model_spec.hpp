#pragma once

#include <Eigen/Core>
#include <limits>
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

/// Tanks in series, the first fed by the input, each draining into the next through an outlet whose
/// flow goes with the square root of its level; the CV is the level of the last. Levels h and flows
/// are relative to the operating point (h = 1, flow 1 there):
///   (T_n / 2) dh_n/dt = inflow_n - sqrt(h_n),  inflow_1 = 1 + (u - u0) / (u0 - empty_input),
///   CV = y0 + (y0 - empty_output) (h_last - 1).
/// No inflow is negative: a closed valve draws nothing back.
/// Around the operating point that is gain / prod (T_n s + 1) with
/// gain = 2 (y0 - empty_output) / (u0 - empty_input). A level never passes its tank's overflow; of
/// what overflows, `spill` falls into the next tank.
struct TankChain {
  std::vector<double> time_constants_s;  ///< of the linearised tanks, each > 0
  double empty_input = 0.0;              ///< input without flow, input units
  double empty_output = 0.0;             ///< CV at an empty last tank, CV units
  std::vector<double> overflow;          ///< relative level, one per tank, > 1; infinity = never;
                                         ///< none given = no tank does
  double spill = 0.0;                    ///< 0..1
  double dead_time_s = 0.0;              ///< >= 0
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
  /// It sticks again after every slip, however the command moves on (He, Wang, Pottmann and Qin
  /// 2007); else it moves on while the command keeps its direction.
  bool slips_once = false;
};
/// An actuator that stays at a value, whatever is commanded.
struct Stuck {
  double value = 0.0;
  /// In force from here on, on the clock of the data; minus infinity = always.
  double onset_s = -std::numeric_limits<double>::infinity();
};
/// An actuator that leaks or whose zero has shifted: it is open by this much more.
struct InputOffset {
  double size = 0.0;
  double onset_s = -std::numeric_limits<double>::infinity();  ///< as that of Stuck
};
/// What does more on one side of a point than on the other: heating is not cooling (split range).
/// Moves count `above` or `below` times; at the operating point nothing is added.
struct TwoSided {
  double above = 1.0, below = 1.0;
  double at = std::numeric_limits<double>::quiet_NaN();  ///< own units; NaN: the operating point
};
/// What does more or less with where another input stands: two valves on one pipe. With du from the
/// operating point the linear part sees (linear + per_unit dv) du, dv that of the other input.
struct Product {
  int of = 0;             ///< the other input
  double per_unit = 0.0;  ///< per unit of the other input
  double linear = 1.0;
};
struct Offset {
  double bias = 0.0;
};
struct Scale {
  double factor = 1.0;  ///< of the deviation from the origin
};
using InputBlock =
    std::variant<Polynomial, Saturation, Deadband, Stiction, Stuck, InputOffset, TwoSided, Product>;
using OutputBlock = std::variant<Saturation, Offset, Scale>;

struct ChannelSpec {
  int cv = 0;
  int input = 0;
  std::variant<TransferFunction, DiscreteFilter, StepResponse, TankChain> dynamics;
  std::optional<InputBlock> input_block = {};  ///< of this channel alone, after the input's own
};

/// A nonlinear function of the CV fed back into the input of one of its channels, which sees
/// u(k) - phi(y(k)), y being that channel's own deviation of the CV from the operating point
/// (Lur'e form): what a linear channel cannot do between its input and its output.
struct RestoringForce {
  double quadratic = 0.0;  ///< phi = quadratic y^2 + cubic y^3
  double cubic = 0.0;
};
struct SquareRootOutflow {
  /// CV at which nothing flows out. With K the channel's steady-state gain, Y = y0 - empty:
  /// phi = (2 Y (sqrt((Y + y) / Y) - 1) - y) / K.
  double empty_output = 0.0;
};
struct CoulombFriction {
  double force = 0.0;  ///< input units; phi = force tanh((y(k) - y(k-1)) / (speed sample_time))
  double speed = 1.0;  ///< CV units per s at which friction is nearly full, > 0
};
using StateBlock = std::variant<RestoringForce, SquareRootOutflow, CoulombFriction>;
struct StateTerm {
  int cv = 0;
  int input = 0;  ///< the channel that it acts through
  StateBlock block;
};

/// What adds itself to a CV at known times, on the clock of the data, before its output block.
enum class DisturbanceShape {
  kStep,      ///< `size` from the onset on, through a first-order lag where time_constant_s > 0;
              ///< passes with a time constant of decay_s where that is finite
  kDrift,     ///< `size` CV units per s from the onset on
  kPeriodic,  ///< size sin(2 pi (t - onset) / period) at all times, or its sign times size
};
struct DisturbanceTerm {
  int cv = 0;
  DisturbanceShape shape = DisturbanceShape::kStep;
  double onset_s = 0.0;
  double size = 0.0;
  double time_constant_s = 0.0;
  double period_s = 0.0;
  bool square = false;  ///< of a periodic one: what a limit cycle switches, not a sine
  double until_s = std::numeric_limits<double>::infinity();  ///< a step goes back, a drift stops
  double decay_s = std::numeric_limits<double>::infinity();  ///< of a step that passes; > 0
};

struct ModelSpec {
  double sample_time_s = 1.0;
  int input_count = 0;  ///< MVs, then DVs
  int cv_count = 0;
  std::vector<ChannelSpec> channels;          ///< at most one per (cv, input); none = no relation
  std::optional<StateSpaceSpec> state_space;  ///< instead of channels
  std::vector<std::optional<InputBlock>> input_blocks;    ///< one per input
  std::vector<std::optional<OutputBlock>> output_blocks;  ///< one per CV
  std::vector<StateTerm> state_terms;                     ///< at most one per channel
  std::vector<DisturbanceTerm> disturbances;              ///< any number; they add up
  Eigen::VectorXd input_origin;                           ///< operating point of the inputs
  Eigen::VectorXd output_origin;                          ///< operating point of the CVs
};

}  // namespace mpm
