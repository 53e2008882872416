#pragma once

#include <functional>

#include "core/identify/search/search.hpp"

/// What is said of the accepted effects once nothing more is found.
namespace mpm {

/// The misfit is no parabola in the widths of play and sticking or in a level of saturation: a row
/// slips or does not. So what the curvature says is widened to where the misfit, with all else
/// fitted, really has risen by as much as a 95 % interval allows. `tell` may throw to end it.
void widen_kinked(Problem& problem, SearchResult& result, const std::function<void()>& tell);

/// A function of time was fitted from its onset on, which is not known: the later a drift begins
/// the steeper it is. So the variances of its numbers are those that they have over all onsets that
/// explain the data nearly as well, each by its odds. `tell` may throw to end it.
void spread_onsets(Problem& problem, SearchResult& result, const std::function<void()>& tell);

/// A level that is off from the first row on by far more than the noise moves it is no small error
/// any more, but a sensor's offset or a disturbance as old as the data: adds those to `result`, but
/// for the CVs in `except` and those that wander, of which no level can be told. In the CVs that
/// are `doubted` something of their channels may be wrong that nobody named: there only what is
/// more than their inputs do that keep to one side of their operating points.
void name_levels(Problem& problem, const std::vector<int>& except, const std::vector<int>& doubted,
                 SearchResult& result);

/// Where structure is missing a CV wanders, and its level cannot be told from a walk's. Names the
/// level of each CV whose constant offset is `known` from another account, in which it comes back,
/// if here it is the same as far as it can be told, and more than its inputs do that keep to one
/// side.
void name_known_levels(Problem& problem, const std::vector<Effect>& known, SearchResult& result);

}  // namespace mpm
