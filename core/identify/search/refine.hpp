#pragma once

#include <vector>

#include "core/identify/search/screening.hpp"
#include "core/identify/search/trial.hpp"

/// What a Gauss-Newton step cannot do, since the misfit has kinks there.
namespace mpm {

/// Moves the onset of a trial about until no other moment is better.
void place_onset(Trials& trials, Trial& trial);
/// Tries the best one's onset for another trial: at the wrong moment a rival may look worse than it
/// is.
void share_onset(Trials& trials, const Trial& best, Trial& trial);

/// Where the best explanation asks for a closer look near it, fits the likeliest of what there is
/// to see and adds them to `trials`, which are sorted by odds and not empty.
void look_closer(Trials& tries, const Screening& screening, std::vector<Trial>& trials);

/// Steps the numbers of a trial about, ever closer, where its cause says how.
void step_about(Trials& trials, Trial& trial);

}  // namespace mpm
