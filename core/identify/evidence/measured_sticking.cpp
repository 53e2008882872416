#include "core/identify/evidence/measured_sticking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/identify/evidence/calibration.hpp"
#include "core/statistics/readback.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

/// Where a valve that sticks so goes from each row to the next, from where it was measured: left
/// alone, one that sticks but a little otherwise slips at other moments, and nothing leads from
/// there to the right one. NaN where command or position is unknown.
VectorXd next_of(const Stiction& valve, const Eigen::Ref<const VectorXd>& command,
                 const Eigen::Ref<const VectorXd>& position) {
  const double rests = 0.5 * (valve.band + valve.jump), slips = 0.5 * (valve.band - valve.jump);
  VectorXd next(position.size());
  int direction = 0;
  for (Index k = 0; k < next.size(); ++k) {
    const double force = command(k) - position(k);
    if (valve.slips_once || k == 0 || sign_of(command(k) - command(k - 1)) != direction)
      direction = 0;
    if (direction == 0 && std::abs(force) > rests) direction = sign_of(force);
    next(k) = direction == 0 ? position(k) + 0.0 * force : command(k) - direction * slips;
  }
  return next;
}

/// Sum of squares of what the valve does otherwise.
double missed_by(const Stiction& valve, const Eigen::Ref<const VectorXd>& command,
                 const Eigen::Ref<const VectorXd>& position) {
  const Index rows = position.size() - 1;
  const Eigen::ArrayXd error = position.tail(rows) - next_of(valve, command, position).head(rows);
  return error.isFinite().select(error.square(), 0.0).sum();
}

/// How far a command usually goes; 0 where it is known too seldom to tell.
double range_of(const Eigen::Ref<const VectorXd>& command) {
  std::vector<double> known;
  for (const double value : command)
    if (std::isfinite(value)) known.push_back(value);
  if (known.size() < static_cast<std::size_t>(rows_to_read_back())) return 0.0;
  std::sort(known.begin(), known.end());
  const auto tail = static_cast<std::size_t>(kTailOfCommands * static_cast<double>(known.size()));
  return known[known.size() - 1 - tail] - known[tail];
}

/// The sticking that comes nearest to a measured position.
Stiction nearest(const Eigen::Ref<const VectorXd>& command,
                 const Eigen::Ref<const VectorXd>& position) {
  const double range = range_of(command);
  Stiction best;
  double least = std::numeric_limits<double>::infinity();
  const auto try_both = [&](double rests, double slips) {
    if (slips < 0.0 || slips > rests) return;
    for (const bool slips_once : {false, true}) {
      const Stiction valve{rests + slips, rests - slips, slips_once};
      const double missed = missed_by(valve, command, position);
      if (missed >= least) continue;
      least = missed;
      best = valve;
    }
  };
  for (double rests = kLeastRest * range; rests <= range; rests *= kWider)
    for (const double share : kSlips) try_both(rests, share * rests);
  for (const double reach : kReaches) {
    const double rests = 0.5 * (best.band + best.jump), slips = 0.5 * (best.band - best.jump);
    for (int i = -kSteps; i <= kSteps; ++i)
      for (int j = -kSteps; j <= kSteps; ++j)
        try_both(rests + i * reach * rests, slips + j * reach * rests);
  }
  return best;
}

}  // namespace

std::vector<MeasuredSticking> measured_sticking(const Recording& recording) {
  std::vector<MeasuredSticking> found;
  const Index rows = std::min(recording.samples(), kMostRowsOfValve);
  for (Index input = 0; input < recording.inputs.cols(); ++input)
    for (Index aux = 0; aux < recording.aux.cols(); ++aux) {
      const auto command = recording.inputs.col(input).head(rows);
      const auto position = recording.aux.col(aux).head(rows);
      const std::optional<double> as_told = share_left(command, position);
      if (!as_told || *as_told > kHardlyTold || !(range_of(command) > 0.0)) continue;
      const Stiction valve = nearest(command, position);
      const std::optional<double> sticking =
          share_left(next_of(valve, command, position), position);
      if (sticking && *sticking < kMostOfPosition * *as_told)
        found.push_back({static_cast<int>(input), static_cast<int>(aux), valve});
    }
  return found;
}

}  // namespace mpm
