#pragma once

#include <Eigen/Core>

#include "core/identify/causes/cause.hpp"

namespace mpm {

/// The quadratic and the cubic restoring force of a channel (`RestoringForce`, in that order) by
/// which its CV goes with least squares where the force is that of the measured CV: what the other
/// channels do taken off, what is left of it is linear in the two (series-parallel; Narendra and
/// Parthasarathy 1990). Biased by noise in the CV, but it needs no start and runs away nowhere,
/// unlike a simulation. Zero where the data do not tell.
[[nodiscard]] Eigen::Vector2d measured_force(const Outlook& outlook, const ChannelSpec& channel);

}  // namespace mpm
