#include "core/identify/diagnosis/state_space_form.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <variant>
#include <vector>

#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// x(k+1) = a x(k) + b u(k), y(k) = c x(k) of one input and one output.
struct Realisation {
  MatrixXd a;
  VectorXd b;
  Eigen::RowVectorXd c;
};

const ChannelSpec* find(const ModelSpec& model, int cv, int input) {
  const auto found =
      std::find_if(model.channels.begin(), model.channels.end(),
                   [&](const ChannelSpec& c) { return c.cv == cv && c.input == input; });
  return found == model.channels.end() ? nullptr : &*found;
}

bool same(const ChannelSpec* a, const ChannelSpec* b) {
  if (a == nullptr || b == nullptr) return a == b;
  const auto* one = std::get_if<StepResponse>(&a->dynamics);
  const auto* other = std::get_if<StepResponse>(&b->dynamics);
  if (one != nullptr && other != nullptr) return one->values == other->values;
  const auto* filter = std::get_if<DiscreteFilter>(&a->dynamics);
  const auto* other_filter = std::get_if<DiscreteFilter>(&b->dynamics);
  return filter != nullptr && other_filter != nullptr &&
         filter->numerator == other_filter->numerator &&
         filter->denominator == other_filter->denominator &&
         filter->delay_samples == other_filter->delay_samples;
}

bool linear(const ModelSpec& model) {
  return model.state_terms.empty() &&
         std::none_of(model.channels.begin(), model.channels.end(), [](const ChannelSpec& c) {
           return c.input_block || std::holds_alternative<TankChain>(c.dynamics);
         });
}

/// Samples after which nothing is left of a unit step; after which it goes on in a line, where the
/// channel integrates.
int settled_after(const ChannelSpec* channel, double sample_time_s) {
  if (channel == nullptr) return 0;
  const LinearModel model(alone(*channel, sample_time_s));
  const auto* filter = std::get_if<DiscreteFilter>(&channel->dynamics);
  if (filter != nullptr && model.integrating()(0, 0))
    return static_cast<int>(filter->numerator.size()) + filter->delay_samples + kLineAfterSettling;
  return model.settling_samples(kSettledShare, kLongestResponse);
}

VectorXd impulse_response(const ChannelSpec* channel, double sample_time_s, int length) {
  return channel == nullptr
             ? VectorXd::Zero(length)
             : LinearModel(alone(*channel, sample_time_s)).impulse_response(0, 0, length);
}

/// Largest deviation of the realised step response from that of `pulse`, whose first value is at
/// the moment of the pulse.
double deviation(const Realisation& system, const VectorXd& pulse) {
  VectorXd state = system.b;
  double difference = 0.0, largest = 0.0;
  for (Index k = 1; k < pulse.size(); ++k) {
    difference += system.c * state - pulse(k);
    largest = std::max(largest, std::abs(difference));
    if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
    state = system.a * state;
  }
  return largest;
}

std::optional<Realisation> realise(const VectorXd& pulse, double tolerance) {
  const Index size = std::min<Index>((pulse.size() - 1) / 2, kLargestHankel);
  if (size < 1) return std::nullopt;
  if (pulse.isZero(0.0)) return Realisation{MatrixXd(0, 0), VectorXd(0), Eigen::RowVectorXd(0)};
  MatrixXd now(size, size), next(size, size);
  for (Index i = 0; i < size; ++i)
    for (Index j = 0; j < size; ++j) {
      now(i, j) = pulse(i + j + 1);
      next(i, j) = i + j + 2 < pulse.size() ? pulse(i + j + 2) : 0.0;
    }
  // Symmetric: its singular values are the magnitudes of its eigenvalues.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(now);
  const VectorXd& values = solver.eigenvalues();
  std::vector<Index> largest_first(static_cast<std::size_t>(size));
  std::iota(largest_first.begin(), largest_first.end(), Index{0});
  std::stable_sort(largest_first.begin(), largest_first.end(), [&values](Index a, Index b) {
    return std::abs(values(a)) > std::abs(values(b));
  });
  const MatrixXd vectors = solver.eigenvectors()(Eigen::all, largest_first);
  const VectorXd sorted = values(largest_first);
  for (Index order = 1; order <= std::min<Index>(size, kMostStatesOfChannel); ++order) {
    if (sorted(order - 1) == 0.0) break;
    const VectorXd root = sorted.head(order).cwiseAbs().cwiseSqrt();
    const VectorXd inverse = root.cwiseInverse();
    const MatrixXd right = vectors.leftCols(order);
    const MatrixXd left = right * sorted.head(order).cwiseSign().asDiagonal();
    Realisation system;
    system.a = inverse.asDiagonal() * left.transpose() * next * right * inverse.asDiagonal();
    system.b = root.cwiseProduct(right.row(0).transpose());
    system.c = left.row(0) * root.asDiagonal();
    if (deviation(system, pulse) <= tolerance) return system;
  }
  return std::nullopt;
}

/// The same of a pulse response that ends in a line, which is an integrator's, exactly.
std::optional<Realisation> realise_beside_line(const VectorXd& pulse, double tolerance) {
  const Index last = pulse.size() - 1;
  const double slope = pulse(last) == pulse(last - 1) ? pulse(last) : 0.0;
  if (slope == 0.0) return realise(pulse, tolerance);
  VectorXd rest = pulse;
  rest.tail(last).array() -= slope;
  std::optional<Realisation> system = realise(rest, tolerance);
  if (!system) return std::nullopt;
  const Index states = system->a.rows();
  system->a.conservativeResizeLike(MatrixXd::Zero(states + 1, states + 1));
  system->a(states, states) = 1.0;
  system->b.conservativeResizeLike(VectorXd::Ones(states + 1));
  system->c.conservativeResizeLike(Eigen::RowVectorXd::Constant(states + 1, slope));
  return system;
}

}  // namespace

std::optional<ModelSpec> in_state_space(const ModelSpec& given, const ModelSpec& base,
                                        const ModelSpec& extended) {
  if (!linear(extended)) return std::nullopt;
  StateSpaceSpec system = *given.state_space;
  if (system.d.size() == 0) system.d = MatrixXd::Zero(given.cv_count, given.input_count);
  const int inputs = extended.input_count;
  system.b.conservativeResizeLike(MatrixXd::Zero(system.a.rows(), inputs));
  system.d.conservativeResizeLike(MatrixXd::Zero(given.cv_count, inputs));
  for (int cv = 0; cv < given.cv_count; ++cv) {
    for (int input = 0; input < inputs; ++input) {
      const ChannelSpec* before = find(base, cv, input);
      const ChannelSpec* after = find(extended, cv, input);
      if (same(before, after)) continue;
      const double sample_time_s = given.sample_time_s;
      const int length =
          std::max(settled_after(before, sample_time_s), settled_after(after, sample_time_s)) + 2;
      const VectorXd wanted = impulse_response(after, sample_time_s, length);
      const VectorXd was = impulse_response(before, sample_time_s, length);
      double level = 0.0, largest = 0.0;
      for (Index k = 0; k < length; ++k) {
        level += wanted(k);
        largest = std::max({largest, std::abs(level)});
      }
      std::optional<Realisation> more =
          realise_beside_line(wanted - was, kStateSpaceDeviation * largest);
      if (!more) return std::nullopt;
      const Index states = system.a.rows(), new_states = more->a.rows();
      if (states + new_states > kMostStates) return std::nullopt;
      system.a.conservativeResizeLike(MatrixXd::Zero(states + new_states, states + new_states));
      system.b.conservativeResizeLike(MatrixXd::Zero(states + new_states, inputs));
      system.c.conservativeResizeLike(MatrixXd::Zero(given.cv_count, states + new_states));
      system.a.bottomRightCorner(new_states, new_states) = more->a;
      system.b.block(states, input, new_states, 1) = more->b;
      system.c.block(cv, states, 1, new_states) = more->c;
      if (system.x0.size() > 0)
        system.x0.conservativeResizeLike(VectorXd::Zero(states + new_states));
    }
  }
  ModelSpec result = extended;
  result.channels.clear();
  result.state_space = std::move(system);
  return result;
}

}  // namespace mpm
