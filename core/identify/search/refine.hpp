#pragma once

#include <vector>

#include "core/identify/search/screening.hpp"
#include "core/identify/search/trial.hpp"

/// What a Gauss-Newton step cannot do, since the misfit has kinks there.
namespace mpm {

/// Moves the onset of a trial about until no other moment is better.
void place_onset(Trials& trials, Trial& trial);

/// How far a valve slips shows in few rows: from coarse starts the fit ends in plain play. So where
/// one input is best explained by play or sticking, looks at all slips near its width and adds the
/// likeliest to `trials`, which are sorted by odds and not empty.
void try_valves(Trials& tries, Screening& screening, std::vector<Trial>& trials);

/// Play and sticking are not smooth in their widths, nor is a square wave in its edges: looks
/// around, ever closer.
void polish(Trials& trials, Trial& trial);

}  // namespace mpm
