#pragma once

#include "core/identify/causes/cause.hpp"

namespace mpm::causes {

/// The signal at `place` acting on its CV through a lag and a dead time to begin a fit from; one of
/// `members` such places. Nothing where either signal hardly moves.
[[nodiscard]] std::optional<Effect> unmodelled_input_at(const Problem& problem, const Place& place,
                                                        std::size_t members, double time_constant_s,
                                                        double dead_time_s);

}  // namespace mpm::causes
