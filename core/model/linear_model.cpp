#include "core/model/linear_model.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/model/static_blocks.hpp"
#include "core/model/zero_order_hold.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using BoolMatrix = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// What is known of one channel without simulating it.
struct ChannelFacts {
  bool exists = false;
  bool integrating = false;
  bool unstable = false;
  double gain = 0.0;       ///< steady state, or slope per sample where integrating
  double slowest = 1.0;    ///< samples
  double dead_time = 0.0;  ///< samples
  Index order = 0;         ///< number of states behind the slowest time constant
};

/// Past inputs (deviations after the static blocks), each stored twice so that any window of the
/// last `capacity` values lies in one piece.
class InputHistory {
 public:
  InputHistory(int inputs, int capacity)
      : capacity_(capacity), values_(static_cast<std::size_t>(2 * inputs * capacity), 0.0) {}

  void fill(int input, double value) {
    const auto first = values_.begin() + 2 * input * capacity_;
    std::fill(first, first + 2 * capacity_, value);
  }
  void next() { newest_ = newest_ + 1 == capacity_ ? 0 : newest_ + 1; }
  void set_newest(int input, double value) {
    double* row = values_.data() + 2 * input * capacity_;
    row[newest_] = value;
    row[newest_ + capacity_] = value;
  }
  /// Points to the newest value; element -l is l samples older, l < capacity.
  [[nodiscard]] const double* newest(int input) const {
    return values_.data() + 2 * input * capacity_ + newest_ + capacity_;
  }

 private:
  int capacity_;
  int newest_ = 0;
  std::vector<double> values_;
};

/// x(k+1) = Phi x(k) + ..., see SampledLag.
struct LagChannel {
  int cv, input;
  SampledLag sampled;
  VectorXd rest;      ///< states per unit of an input held for ever, integrator at 0
  Index first_state;  ///< in the common state vector
};

/// y(k+1) = b0 u(k-delay) + z1(k), z_i(k+1) = b_i u(k-delay) + z_{i+1}(k) - a_i y(k+1): the
/// transposed direct form, states (y, z1 .. zn).
struct FilterChannel {
  int cv, input, delay;
  VectorXd numerator, denominator;  ///< n+1 coefficients each, denominator(0) = 1
  VectorXd rest;                    ///< states per unit of an input held for ever
  Index first_state;
};

/// y(k+1) = sum_j weights(j) u(k-(last-j)), oldest first.
struct FirChannel {
  int cv, input;
  VectorXd weights;
};

/// Spectral split of a discrete state matrix at its eigenvalue 1.
struct StateSpaceFacts {
  MatrixXd rest;  ///< states per unit of each held input, integrating parts at rest
  MatrixXd gain;
  BoolMatrix integrating;
  double slowest = 1.0;
  bool unstable = false;
};

double slowest_from_radius(double radius) {
  return radius <= 0.0 ? 1.0 : std::max(1.0, -1.0 / std::log(radius));
}

/// P projects on the (generalised) eigenspace of eigenvalue 1 along all others, I - A + P is
/// regular, and x = (I - A + P)^-1 (I - P) B u is the rest state (Drazin inverse).
StateSpaceFacts analyse(const StateSpaceSpec& system) {
  constexpr double kUnitTolerance = 1e-9;
  const Index order = system.a.rows();
  StateSpaceFacts facts;
  facts.integrating = BoolMatrix::Constant(system.d.rows(), system.d.cols(), false);
  facts.gain = system.d;
  facts.rest = MatrixXd::Zero(order, system.b.cols());
  if (order == 0) return facts;

  const Eigen::VectorXcd poles = system.a.eigenvalues();
  double radius = 0.0;
  bool has_integrator = false;
  for (Index i = 0; i < order; ++i) {
    if (std::abs(poles(i) - 1.0) < kUnitTolerance)
      has_integrator = true;
    else if (std::abs(poles(i)) >= 1.0)
      facts.unstable = true;
    else
      radius = std::max(radius, std::abs(poles(i)));
  }
  facts.slowest = slowest_from_radius(radius);

  const MatrixXd identity = MatrixXd::Identity(order, order);
  const MatrixXd difference = identity - system.a;
  MatrixXd projector = MatrixXd::Zero(order, order);
  if (has_integrator) {
    const MatrixXd squared = difference * difference;  // index 2 covers double integrators
    Eigen::FullPivLU<MatrixXd> right(squared), left(squared.transpose());
    right.setThreshold(kUnitTolerance);
    left.setThreshold(kUnitTolerance);
    const MatrixXd right_basis = right.kernel();
    const MatrixXd left_basis = left.kernel();
    const MatrixXd overlap = left_basis.transpose() * right_basis;
    projector = right_basis * overlap.fullPivLu().solve(left_basis.transpose());
  }
  facts.rest = (difference + projector).fullPivLu().solve((identity - projector) * system.b);
  facts.gain = system.c * facts.rest + system.d;
  const MatrixXd slope = system.c * projector * system.b;
  const MatrixXd growth = system.c * difference * projector * system.b;
  const double scale = 1.0 + system.b.cwiseAbs().maxCoeff() * system.c.cwiseAbs().maxCoeff();
  for (Index cv = 0; cv < slope.rows(); ++cv) {
    for (Index input = 0; input < slope.cols(); ++input) {
      const bool doubled = std::abs(growth(cv, input)) > kUnitTolerance * scale;
      if (!doubled && std::abs(slope(cv, input)) <= kUnitTolerance * scale) continue;
      facts.integrating(cv, input) = true;
      facts.gain(cv, input) =
          doubled ? std::copysign(std::numeric_limits<double>::infinity(), -growth(cv, input))
                  : slope(cv, input);
    }
  }
  return facts;
}

void check_state_space(const StateSpaceSpec& system, int inputs, int cvs) {
  const Index order = system.a.rows();
  if (system.a.cols() != order || system.b.rows() != order || system.b.cols() != inputs ||
      system.c.rows() != cvs || system.c.cols() != order || system.d.rows() != cvs ||
      system.d.cols() != inputs || (system.x0.size() != 0 && system.x0.size() != order))
    throw std::invalid_argument("state space: matrix sizes do not match");
  if (!system.a.allFinite() || !system.b.allFinite() || !system.c.allFinite() ||
      !system.d.allFinite() || !system.x0.allFinite())
    throw std::invalid_argument("state space: entries must be finite");
}

VectorXd or_zero(const VectorXd& vector, int size, const char* name) {
  if (vector.size() == 0) return VectorXd::Zero(size);
  if (vector.size() != size || !vector.allFinite())
    throw std::invalid_argument(std::string(name) + ": one finite value per signal expected");
  return vector;
}

/// Everything that does not change while the model runs.
struct Definition {
  explicit Definition(ModelSpec given);

  ModelSpec spec;
  VectorXd input_origin, output_origin;
  std::vector<LagChannel> lags;
  std::vector<FilterChannel> filters;
  std::vector<FirChannel> firs;
  std::optional<StateSpaceFacts> state_space;
  std::vector<ChannelFacts> facts;  ///< cv_count x input_count, row by row
  Index state_count = 0;
  int history = 1;  ///< input values that the channels look back on

  [[nodiscard]] const ChannelFacts& fact(int cv, int input) const {
    return facts[static_cast<std::size_t>(cv * spec.input_count + input)];
  }

 private:
  ChannelFacts add(const ChannelSpec& channel, const TransferFunction& transfer);
  ChannelFacts add(const ChannelSpec& channel, const DiscreteFilter& filter);
  ChannelFacts add(const ChannelSpec& channel, const StepResponse& response);
  void add_state_space(const StateSpaceSpec& system);
};

Definition::Definition(ModelSpec given) : spec(std::move(given)) {
  if (spec.cv_count < 0 || spec.input_count < 0)
    throw std::invalid_argument("model: negative number of signals");
  input_origin = or_zero(spec.input_origin, spec.input_count, "operating point of the inputs");
  output_origin = or_zero(spec.output_origin, spec.cv_count, "operating point of the CVs");
  const auto inputs = static_cast<std::size_t>(spec.input_count);
  const auto cvs = static_cast<std::size_t>(spec.cv_count);
  if (!spec.input_blocks.empty() && spec.input_blocks.size() != inputs)
    throw std::invalid_argument("input blocks: one entry per input expected");
  if (!spec.output_blocks.empty() && spec.output_blocks.size() != cvs)
    throw std::invalid_argument("output blocks: one entry per CV expected");
  spec.input_blocks.resize(inputs);
  spec.output_blocks.resize(cvs);
  for (const std::optional<OutputBlock>& block : spec.output_blocks)
    if (block) check_output_block(*block);

  facts.resize(cvs * inputs);
  if (spec.state_space) {
    if (!spec.channels.empty())
      throw std::invalid_argument("model: either channels or a state space, not both");
    add_state_space(*spec.state_space);
    return;
  }
  for (const ChannelSpec& channel : spec.channels) {
    if (channel.cv < 0 || channel.cv >= spec.cv_count || channel.input < 0 ||
        channel.input >= spec.input_count)
      throw std::invalid_argument("channel: no such CV or input");
    ChannelFacts& slot =
        facts[static_cast<std::size_t>(channel.cv * spec.input_count + channel.input)];
    if (slot.exists) throw std::invalid_argument("channel: given twice");
    slot =
        std::visit([&](const auto& dynamics) { return add(channel, dynamics); }, channel.dynamics);
    slot.exists = true;
  }
}

ChannelFacts Definition::add(const ChannelSpec& channel, const TransferFunction& transfer) {
  LagChannel lag{channel.cv,
                 channel.input,
                 sample_transfer_function(transfer, spec.sample_time_s),
                 {},
                 state_count};
  const Index order = lag.sampled.output.size();
  lag.rest = VectorXd::Ones(order);
  if (transfer.integrating) lag.rest(order - 1) = 0.0;
  state_count += order;
  history = std::max(history, lag.sampled.delay + 2);

  ChannelFacts result;
  result.integrating = transfer.integrating;
  result.gain = transfer.gain * (transfer.integrating ? spec.sample_time_s : 1.0);
  result.dead_time = transfer.dead_time_s / spec.sample_time_s;
  result.order = order;
  for (const double time_constant_s : transfer.time_constants_s)
    result.slowest = std::max(result.slowest, time_constant_s / spec.sample_time_s);
  lags.push_back(std::move(lag));
  return result;
}

ChannelFacts Definition::add(const ChannelSpec& channel, const DiscreteFilter& filter) {
  const auto finite = [](double value) { return std::isfinite(value); };
  if (filter.numerator.empty() || filter.denominator.empty() || filter.denominator[0] == 0.0)
    throw std::invalid_argument("filter: numerator and a non-zero leading denominator expected");
  if (!std::all_of(filter.numerator.begin(), filter.numerator.end(), finite) ||
      !std::all_of(filter.denominator.begin(), filter.denominator.end(), finite))
    throw std::invalid_argument("filter: coefficients must be finite");
  if (filter.delay_samples < 0 || filter.delay_samples > 1000000)
    throw std::invalid_argument("filter: delay must be in 0 .. 1e6 samples");

  const std::size_t count = std::max(filter.numerator.size(), filter.denominator.size());
  const auto order = static_cast<Index>(count) - 1;
  FilterChannel fir_iir{channel.cv,
                        channel.input,
                        filter.delay_samples,
                        VectorXd::Zero(order + 1),
                        VectorXd::Zero(order + 1),
                        VectorXd::Zero(order + 1),
                        state_count};
  VectorXd& b = fir_iir.numerator;
  VectorXd& a = fir_iir.denominator;
  for (std::size_t i = 0; i < filter.numerator.size(); ++i)
    b(static_cast<Index>(i)) = filter.numerator[i] / filter.denominator[0];
  for (std::size_t i = 0; i < filter.denominator.size(); ++i)
    a(static_cast<Index>(i)) = filter.denominator[i] / filter.denominator[0];
  state_count += order + 1;
  history = std::max(history, filter.delay_samples + 1);

  ChannelFacts result;
  result.order = order;
  result.dead_time = filter.delay_samples;
  for (Index i = 0; i < b.size() && b(i) == 0.0; ++i) result.dead_time += 1.0;
  constexpr double kUnitTolerance = 1e-9;
  result.integrating = std::abs(a.sum()) <= kUnitTolerance * a.cwiseAbs().sum();
  double radius = 0.0;
  if (order > 0) {
    MatrixXd companion = MatrixXd::Zero(order, order);
    companion.row(0) = -a.tail(order).transpose();
    companion.bottomLeftCorner(order - 1, order - 1).setIdentity();
    for (const std::complex<double>& pole : companion.eigenvalues()) {
      if (result.integrating && std::abs(pole - 1.0) < 1e-6) continue;
      if (std::abs(pole) >= 1.0) result.unstable = true;
      radius = std::max(radius, std::abs(pole));
    }
  }
  result.slowest = result.unstable ? 1.0 : slowest_from_radius(radius);

  // With a simple pole at 1, A(q) = (1 - q) A1(q) and A1(1) = -A'(1): the output ramps.
  const double slope_denominator =
      -a.dot(VectorXd::LinSpaced(order + 1, 0.0, static_cast<double>(order)));
  result.gain = result.integrating ? b.sum() / slope_denominator : b.sum() / a.sum();

  // The states after an input of 1 held for ever, y(k-j) = level - slope j.
  const double level = result.integrating ? 0.0 : result.gain;
  const double slope = result.integrating ? result.gain : 0.0;
  fir_iir.rest(0) = level;
  for (Index i = 1; i <= order; ++i)
    for (Index m = i; m <= order; ++m)
      fir_iir.rest(i) += b(m) - a(m) * (level - slope * static_cast<double>(m - i));
  filters.push_back(std::move(fir_iir));
  return result;
}

ChannelFacts Definition::add(const ChannelSpec& channel, const StepResponse& response) {
  if (response.values.empty()) throw std::invalid_argument("step response: values expected");
  for (const double value : response.values)
    if (!std::isfinite(value)) throw std::invalid_argument("step response: values must be finite");

  // weights h(1) .. h(L-1), newest input last. A direct part values[0] acts on the input just
  // before the sampling instant, as everywhere: it is within values[1].
  std::vector<double> steps = response.values;
  if (steps.size() == 1) steps.push_back(steps[0]);
  while (steps.size() > 2 && steps.back() == steps[steps.size() - 2]) steps.pop_back();
  steps[0] = 0.0;
  const auto length = static_cast<Index>(steps.size()) - 1;
  FirChannel fir{channel.cv, channel.input, VectorXd::Zero(length)};
  for (Index lag = 1; lag <= length; ++lag)
    fir.weights(length - lag) =
        steps[static_cast<std::size_t>(lag)] - steps[static_cast<std::size_t>(lag - 1)];
  history = std::max(history, static_cast<int>(length));

  ChannelFacts result;
  result.gain = steps.back();
  result.order = 0;
  const double size =
      std::abs(*std::max_element(steps.begin(), steps.end(), [](double left, double right) {
        return std::abs(left) < std::abs(right);
      }));
  std::size_t first = 1;
  while (first + 1 < steps.size() && std::abs(steps[first]) <= 1e-3 * size) ++first;
  result.dead_time = static_cast<double>(first - 1);
  std::size_t last_far = first - 1;
  for (std::size_t i = first; i < steps.size(); ++i)
    if (std::abs(steps[i] - result.gain) > std::exp(-1.0) * std::abs(result.gain)) last_far = i;
  result.slowest = std::max(1.0, static_cast<double>(last_far + 1 - first));
  firs.push_back(std::move(fir));
  return result;
}

void Definition::add_state_space(const StateSpaceSpec& system) {
  check_state_space(system, spec.input_count, spec.cv_count);
  state_space = analyse(system);
  state_count = system.a.rows();
  history = 1;

  // Dead time of a channel: steps until its response to a pulse first differs from zero.
  const double scale = 1e-9 * (1.0 + system.b.cwiseAbs().sum() * system.c.cwiseAbs().sum());
  MatrixXd states = system.b;
  MatrixXd pulse = system.c * system.b + system.d;
  for (Index step = 0; step <= state_count; ++step) {
    for (int cv = 0; cv < spec.cv_count; ++cv) {
      for (int input = 0; input < spec.input_count; ++input) {
        ChannelFacts& slot = facts[static_cast<std::size_t>(cv * spec.input_count + input)];
        if (slot.exists || std::abs(pulse(cv, input)) <= scale) continue;
        slot.exists = true;
        slot.dead_time = static_cast<double>(step);
        slot.integrating = state_space->integrating(cv, input);
        slot.unstable = state_space->unstable;
        slot.gain = state_space->gain(cv, input);
        slot.slowest = state_space->slowest;
        slot.order = state_count;
      }
    }
    states = system.a * states;
    pulse = system.c * states;
  }
}

/// The unit-step response of one channel stays within `tolerance` from the returned sample on.
int settling_of(LinearModel& channel, const ChannelFacts& facts, double tolerance, int limit) {
  if (facts.unstable) return limit;
  const double order = static_cast<double>(facts.order);
  const double horizon = facts.dead_time + 10.0 +
                         facts.slowest * (10.0 + 5.0 * order + 2.0 * std::log1p(1.0 / tolerance));
  const int length = horizon < limit ? static_cast<int>(horizon) : limit;
  channel.reset();
  const VectorXd unit = VectorXd::Ones(1);
  const double final_value = facts.gain;
  double peak = 0.0;
  int settled = 0;
  // A channel without steady-state gain is measured against the largest value it reached.
  const auto bound = [&] {
    return tolerance * (final_value != 0.0 ? std::abs(final_value) : peak);
  };
  for (int k = 0; k < length; ++k) {
    const double value = channel.output()(0);
    peak = std::max(peak, std::abs(value));
    if (std::abs(value - final_value) > bound()) settled = k + 1;
    channel.advance(unit);
  }
  return std::min(settled, limit);
}

}  // namespace

struct LinearModel::State {
  explicit State(const ModelSpec& spec)
      : definition(std::make_shared<const Definition>(spec)),
        history(definition->spec.input_count, definition->history),
        states(VectorXd::Zero(definition->state_count)),
        next_states(VectorXd::Zero(definition->state_count)),
        last_input(definition->input_origin),
        linear_output(VectorXd::Zero(definition->spec.cv_count)),
        output(VectorXd::Zero(definition->spec.cv_count)) {
    for (Index i = 0; i < definition->input_origin.size(); ++i)
      elements.emplace_back(definition->spec.input_blocks[static_cast<std::size_t>(i)],
                            definition->input_origin(i));
  }

  void compute_output();
  void step_lag(const LagChannel& lag);
  void step_filter(const FilterChannel& filter);

  std::shared_ptr<const Definition> definition;  ///< shared by copies
  std::vector<InputElement> elements;
  InputHistory history;
  VectorXd states, next_states;
  VectorXd last_input;
  VectorXd linear_output, output;
};

/// From the states at k+1 and the inputs up to k.
void LinearModel::State::compute_output() {
  const Definition& fixed = *definition;
  linear_output.setZero();
  for (const LagChannel& lag : fixed.lags) {
    const Index order = lag.sampled.output.size();
    double value = lag.sampled.feed_through * history.newest(lag.input)[-lag.sampled.delay];
    for (Index i = std::max<Index>(0, order - 2); i < order; ++i)
      value += lag.sampled.output(i) * states(lag.first_state + i);
    linear_output(lag.cv) += value;
  }
  for (const FilterChannel& filter : fixed.filters)
    linear_output(filter.cv) += states(filter.first_state);
  for (const FirChannel& fir : fixed.firs) {
    const Index length = fir.weights.size();
    const Eigen::Map<const VectorXd> window(history.newest(fir.input) - (length - 1), length);
    linear_output(fir.cv) += fir.weights.dot(window);
  }
  if (fixed.spec.state_space) {
    linear_output.noalias() += fixed.spec.state_space->c * states;
    for (int input = 0; input < fixed.spec.input_count; ++input)
      linear_output += fixed.spec.state_space->d.col(input) * *history.newest(input);
  }
  for (Index cv = 0; cv < output.size(); ++cv)
    output(cv) = apply_output_block(fixed.spec.output_blocks[static_cast<std::size_t>(cv)],
                                    fixed.output_origin(cv), linear_output(cv));
}

void LinearModel::State::step_lag(const LagChannel& lag) {
  const SampledLag& sampled = lag.sampled;
  const Index order = sampled.output.size();
  const double newer = history.newest(lag.input)[-sampled.delay];
  const double older = history.newest(lag.input)[-sampled.delay - 1];
  double* x = states.data() + lag.first_state;
  // Lower triangular, so the rows are taken from the last one and no copy is needed.
  for (Index i = order; i-- > 0;) {
    double value = sampled.from_newer(i) * newer + sampled.from_older(i) * older;
    for (Index j = 0; j <= i; ++j) value += sampled.transition(i, j) * x[j];
    x[i] = value;
  }
}

void LinearModel::State::step_filter(const FilterChannel& filter) {
  const double u = history.newest(filter.input)[-filter.delay];
  double* z = states.data() + filter.first_state;
  const Index order = filter.numerator.size() - 1;
  const double y = filter.numerator(0) * u + (order > 0 ? z[1] : 0.0);
  z[0] = y;
  for (Index i = 1; i <= order; ++i)
    z[i] = filter.numerator(i) * u - filter.denominator(i) * y + (i < order ? z[i + 1] : 0.0);
}

LinearModel::LinearModel(const ModelSpec& spec) : state_(std::make_unique<State>(spec)) { reset(); }
LinearModel::LinearModel(LinearModel&&) noexcept = default;
LinearModel& LinearModel::operator=(LinearModel&&) noexcept = default;
LinearModel::LinearModel(const LinearModel& other)
    : state_(std::make_unique<State>(*other.state_)) {}
LinearModel& LinearModel::operator=(const LinearModel& other) {
  if (this != &other) *state_ = *other.state_;
  return *this;
}
LinearModel::~LinearModel() = default;

int LinearModel::input_count() const { return state_->definition->spec.input_count; }
int LinearModel::cv_count() const { return state_->definition->spec.cv_count; }

void LinearModel::reset() {
  reset_steady(state_->definition->input_origin);
  const std::optional<StateSpaceSpec>& system = state_->definition->spec.state_space;
  if (!system) return;
  if (system->x0.size() != 0)
    state_->states = system->x0;
  else
    state_->states.setZero();
  state_->compute_output();
}

void LinearModel::reset_steady(const Eigen::Ref<const VectorXd>& input) {
  State& state = *state_;
  const Definition& fixed = *state.definition;
  state.states.setZero();
  for (int i = 0; i < fixed.spec.input_count; ++i) {
    if (std::isfinite(input(i))) state.last_input(i) = input(i);
    InputElement& element = state.elements[static_cast<std::size_t>(i)];
    element.reset(state.last_input(i));
    const double deviation = element.apply(state.last_input(i));
    state.history.fill(i, deviation);
    if (fixed.state_space) state.states += fixed.state_space->rest.col(i) * deviation;
  }
  for (const LagChannel& lag : fixed.lags)
    state.states.segment(lag.first_state, lag.rest.size()) =
        lag.rest * *state.history.newest(lag.input);
  for (const FilterChannel& filter : fixed.filters)
    state.states.segment(filter.first_state, filter.rest.size()) =
        filter.rest * *state.history.newest(filter.input);
  state.compute_output();
}

const VectorXd& LinearModel::output() const { return state_->output; }

void LinearModel::advance(const Eigen::Ref<const VectorXd>& input) {
  State& state = *state_;
  const Definition& fixed = *state.definition;
  state.history.next();
  for (int i = 0; i < fixed.spec.input_count; ++i) {
    if (std::isfinite(input(i))) state.last_input(i) = input(i);
    const double deviation = state.elements[static_cast<std::size_t>(i)].apply(state.last_input(i));
    state.history.set_newest(i, deviation);
  }
  for (const LagChannel& lag : fixed.lags) state.step_lag(lag);
  for (const FilterChannel& filter : fixed.filters) state.step_filter(filter);
  if (fixed.spec.state_space) {
    state.next_states.noalias() = fixed.spec.state_space->a * state.states;
    for (int i = 0; i < fixed.spec.input_count; ++i)
      state.next_states += fixed.spec.state_space->b.col(i) * *state.history.newest(i);
    state.states.swap(state.next_states);
  }
  state.compute_output();
}

VectorXd LinearModel::impulse_response(int cv, int input, int length) const {
  VectorXd response = VectorXd::Zero(std::max(0, length));
  if (!state_->definition->fact(cv, input).exists) return response;
  LinearModel channel = single_channel(cv, input);
  VectorXd pulse = VectorXd::Ones(1);
  for (Index k = 0; k < response.size(); ++k) {
    response(k) = channel.output()(0);
    channel.advance(pulse);
    pulse.setZero();
  }
  return response;
}

MatrixXd LinearModel::steady_gain() const {
  MatrixXd gain(cv_count(), input_count());
  for (int cv = 0; cv < cv_count(); ++cv)
    for (int input = 0; input < input_count(); ++input)
      gain(cv, input) = state_->definition->fact(cv, input).gain;
  return gain;
}

BoolMatrix LinearModel::integrating() const {
  BoolMatrix result(cv_count(), input_count());
  for (int cv = 0; cv < cv_count(); ++cv)
    for (int input = 0; input < input_count(); ++input)
      result(cv, input) = state_->definition->fact(cv, input).integrating;
  return result;
}

int LinearModel::settling_samples(double tolerance, int limit) const {
  int samples = 0;
  for (int cv = 0; cv < cv_count(); ++cv) {
    for (int input = 0; input < input_count(); ++input) {
      const ChannelFacts& facts = state_->definition->fact(cv, input);
      if (!facts.exists || facts.integrating) continue;
      LinearModel channel = single_channel(cv, input);
      samples = std::max(samples, settling_of(channel, facts, tolerance, limit));
    }
  }
  return samples;
}

double LinearModel::slowest_time_constant_samples() const {
  double slowest = 1.0;
  for (const ChannelFacts& facts : state_->definition->facts)
    slowest = std::max(slowest, facts.slowest);
  return slowest;
}

double LinearModel::longest_dead_time_samples() const {
  double longest = 0.0;
  for (const ChannelFacts& facts : state_->definition->facts)
    longest = std::max(longest, facts.dead_time);
  return longest;
}

/// The linear part of one channel as a model of its own, in deviations, at rest.
LinearModel LinearModel::single_channel(int cv, int input) const {
  const ModelSpec& spec = state_->definition->spec;
  ModelSpec one;
  one.sample_time_s = spec.sample_time_s;
  one.input_count = 1;
  one.cv_count = 1;
  if (spec.state_space)
    one.state_space = StateSpaceSpec{spec.state_space->a,
                                     spec.state_space->b.col(input),
                                     spec.state_space->c.row(cv),
                                     spec.state_space->d.block(cv, input, 1, 1),
                                     {}};
  for (const ChannelSpec& channel : spec.channels)
    if (channel.cv == cv && channel.input == input)
      one.channels.push_back({0, 0, channel.dynamics});
  return LinearModel(one);
}

}  // namespace mpm
