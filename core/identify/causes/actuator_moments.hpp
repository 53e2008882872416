#pragma once

#include <vector>

#include "core/identify/causes/cause.hpp"

namespace mpm {

/// From when on an actuator would not do as it is told, and how much that would explain.
struct ActuatorMoment {
  Eigen::Index onset = 0;  ///< row
  double value = 0.0;      ///< size of the offset, or where it sticks; input units
};

/// The rows from which on an offset of `input`, as large as fits best, would explain most of the
/// innovations of all CVs that it acts on; best first, no two within a few rows. Every row is
/// tried: what comes through a channel shows for little longer than the channel takes to settle.
[[nodiscard]] std::vector<ActuatorMoment> offset_moments(const Outlook& outlook, int input,
                                                         std::size_t most);
/// The same for an actuator that stays where it is then, wherever that fits best; half of them
/// as if nothing else were wrong and the noise white.
[[nodiscard]] std::vector<ActuatorMoment> stuck_moments(const Outlook& outlook, int input,
                                                        std::size_t most);

}  // namespace mpm
