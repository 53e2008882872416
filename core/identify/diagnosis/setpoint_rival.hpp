#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/identify/search/search.hpp"

/// Channels against set-points. Under feedback inputs are what set-points and CVs make them: what a
/// wrong channel does can be said by a set-point too, beside another noise, and the other way
/// round. Between them the calibrated test decides (`ChannelTests::setpoint`), or nobody.
/// Everywhere `first`: of the aux signals the first that is a set-point; one per CV, in their
/// order.
namespace mpm {

/// The controller makes a CV follow its set-point, so that any share of the CV does.
inline constexpr const char* kOwnSetpoint =
    "a CV follows its own set-point: a wrong gain, its sensor's span and a disturbance that moves "
    "with the set-point look the same";

/// What a CV's own set-point does where the test rejects no channel of the CV, or says that the
/// set-point explains clearly more; what another's does always.
[[nodiscard]] bool may_name_setpoint(const Effect& effect, const ChannelTests& tests, int first);

/// Whether the test does not decide between the channels of a CV and its own set-point.
[[nodiscard]] bool own_setpoint_undecided(const ChannelTests& tests, int cv);

/// How often a signal moves: stretches of rows on which it rises, or falls.
[[nodiscard]] int moves(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Why what a set-point is said to do is no finding, for a person; null where it may be one: what a
/// set-point does but through inputs takes strong evidence. `alone`: nothing else was found in the
/// CV that would hide the channels' word. `moves`: of the set-point in the rows that were fitted;
/// what goes on by itself goes with a few of them by chance.
[[nodiscard]] const char* why_not_setpoint(const Named& named, bool alone, int moves,
                                           const ChannelTests& tests, int first);

/// Why a step of a CV is no disturbance, for a person; null where it may be one. `signals`: what
/// the problem was made of, row for row; `all`: what was found. A step just after the CV's
/// set-point's, and the same way, is the loop's answer to it: a valve that sticks slips so. But an
/// answer comes more than once: one step alone that comes with one move of many came so by chance.
[[nodiscard]] const char* why_not_step(const Effect& effect, const std::vector<Named>& all,
                                       const ModelSpec& model, const Recording& signals);

/// Where the test does not decide: the own set-point becomes a rival of what is laid to channels of
/// the CV, as probable beside it as before any data, and takes its share of the confidence.
void add_own_setpoint(const Effect& effect, const ChannelTests& tests, int first, Finding& finding);

}  // namespace mpm
