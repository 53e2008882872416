#include "core/model/state_space.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "core/model/calibration.hpp"
#include "core/model/eigenvalues.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

using calibration::model_rounding::kSame;

/// Sets `slowest` and `unstable`; true where an eigenvalue is 1.
bool judge_poles(const MatrixXd& transition, StateSpaceFacts& facts) {
  const Eigen::VectorXcd poles = transition.eigenvalues();
  double radius = 0.0;
  bool has_integrator = false;
  for (Index i = 0; i < poles.size(); ++i) {
    if (std::abs(poles(i) - 1.0) < kSame)
      has_integrator = true;
    else if (std::abs(poles(i)) >= 1.0)
      facts.unstable = true;
    else
      radius = std::max(radius, std::abs(poles(i)));
  }
  facts.slowest = slowest_from_radius(radius);
  return has_integrator;
}

/// On the (generalised) eigenspace of eigenvalue 1 along all others; `difference` is I - A.
MatrixXd integrator_projector(const MatrixXd& difference) {
  const MatrixXd squared = difference * difference;  // index 2 covers double integrators
  Eigen::FullPivLU<MatrixXd> right(squared), left(squared.transpose());
  right.setThreshold(kSame);
  left.setThreshold(kSame);
  const MatrixXd right_basis = right.kernel();
  const MatrixXd left_basis = left.kernel();
  const MatrixXd overlap = left_basis.transpose() * right_basis;
  return right_basis * overlap.fullPivLu().solve(left_basis.transpose());
}

}  // namespace

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

/// P projects on the (generalised) eigenspace of eigenvalue 1 along all others, I - A + P is
/// regular, and x = (I - A + P)^-1 (I - P) B u is the rest state (Drazin inverse).
StateSpaceFacts analyse_state_space(const StateSpaceSpec& system) {
  const Index order = system.a.rows();
  StateSpaceFacts facts;
  facts.integrating.setConstant(system.d.rows(), system.d.cols(), false);
  facts.gain = system.d;
  facts.rest = MatrixXd::Zero(order, system.b.cols());
  if (order == 0) return facts;

  const MatrixXd identity = MatrixXd::Identity(order, order);
  const MatrixXd difference = identity - system.a;
  MatrixXd projector = MatrixXd::Zero(order, order);
  if (judge_poles(system.a, facts)) projector = integrator_projector(difference);
  facts.rest = (difference + projector).fullPivLu().solve((identity - projector) * system.b);
  facts.gain = system.c * facts.rest + system.d;
  const MatrixXd slope = system.c * projector * system.b;
  const MatrixXd growth = system.c * difference * projector * system.b;
  const double scale = 1.0 + system.b.cwiseAbs().maxCoeff() * system.c.cwiseAbs().maxCoeff();
  for (Index cv = 0; cv < slope.rows(); ++cv) {
    for (Index input = 0; input < slope.cols(); ++input) {
      const bool doubled = std::abs(growth(cv, input)) > kSame * scale;
      if (!doubled && std::abs(slope(cv, input)) <= kSame * scale) continue;
      facts.integrating(cv, input) = true;
      facts.gain(cv, input) =
          doubled ? std::copysign(std::numeric_limits<double>::infinity(), -growth(cv, input))
                  : slope(cv, input);
    }
  }
  return facts;
}

std::vector<ChannelFacts> channel_facts(const StateSpaceSpec& system,
                                        const StateSpaceFacts& facts) {
  const Index cvs = system.d.rows();
  const Index inputs = system.d.cols();
  const Index order = system.a.rows();
  std::vector<ChannelFacts> result(static_cast<std::size_t>(cvs * inputs));

  // Dead time of a channel: steps until its response to a pulse first differs from zero.
  const double scale = kSame * (1.0 + system.b.cwiseAbs().sum() * system.c.cwiseAbs().sum());
  MatrixXd states = system.b;
  MatrixXd pulse = system.c * system.b + system.d;
  for (Index step = 0; step <= order; ++step) {
    for (Index cv = 0; cv < cvs; ++cv) {
      for (Index input = 0; input < inputs; ++input) {
        ChannelFacts& slot = result[static_cast<std::size_t>(cv * inputs + input)];
        if (slot.exists || std::abs(pulse(cv, input)) <= scale) continue;
        slot.exists = true;
        slot.dead_time = static_cast<double>(step);
        slot.integrating = facts.integrating(cv, input);
        slot.unstable = facts.unstable;
        slot.gain = facts.gain(cv, input);
        slot.slowest = facts.slowest;
        slot.order = order;
      }
    }
    states = system.a * states;
    pulse = system.c * states;
  }
  return result;
}

}  // namespace mpm
