#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/valves/oscillation.hpp"

/// What half cycles of a swing look like. A valve that sticks moves in jumps: behind one the
/// process value of a self-regulating process goes as an exponential does, and a controller's
/// output, or the value of an integrating process, as a straight line. What a controller swings by
/// itself, or follows, is round.
namespace mpm {

/// How much better straight lines fit than round ones: S / (S + T), S and T the squared errors of
/// quarter sines and of straight lines up to a peak and down from it, wherever that is. 0.5 = both
/// alike; He, Wang, Pottmann and Qin (Ind. Eng. Chem. Res. 46, 2007) call above 0.6 sticking and
/// below 0.4 not. NaN without half cycles. (Theirs is a whole half sine; with a peak as free as the
/// lines' a skewed round swing stays round.)
[[nodiscard]] double triangle_index(const Eigen::Ref<const Eigen::VectorXd>& swing,
                                    const std::vector<HalfCycle>& halves);

/// (S - R) / (S + R), S and R the squared errors of a half sine and of the best response of a first
/// order lag to a relay, which with a long lag is a triangle (Rossi and Scali, J. Process Control
/// 15, 2005: above 0.21 sticking, below -0.21 not). NaN without half cycles.
[[nodiscard]] double relay_index(const Eigen::Ref<const Eigen::VectorXd>& swing,
                                 const std::vector<HalfCycle>& halves);

/// Share of the time in which the controller's output moves and the process value rests, of that in
/// which either moves (Yamashita, Control Eng. Practice 14, 2006, rho 1; above 0.25 sticking): for
/// loops that follow their valve at once. Moves are over a tenth of the `period`, and count from
/// their s.d. on. NaN where nothing moves.
[[nodiscard]] double resting_index(const Eigen::Ref<const Eigen::VectorXd>& output,
                                   const Eigen::Ref<const Eigen::VectorXd>& value, double period);

}  // namespace mpm
