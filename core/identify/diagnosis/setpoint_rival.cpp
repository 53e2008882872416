#include "core/identify/diagnosis/setpoint_rival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/priors.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {
namespace {

constexpr double kMostRows = 1e9;

/// Rows in which the quickest channel of a CV answers: its dead time and its slowest lag.
Eigen::Index rows_of_answer(const ModelSpec& model, int cv) {
  double quickest = std::numeric_limits<double>::infinity();
  for (const ChannelSpec& channel : model.channels)
    if (channel.cv == cv)
      quickest = std::min(quickest, removable_dead_time_s(channel, model.sample_time_s) +
                                        slowest_time_constant_s(channel, model.sample_time_s));
  return static_cast<Eigen::Index>(std::min(std::ceil(quickest / model.sample_time_s), kMostRows));
}

/// How far the CV's set-point has moved at a row since it last could do nothing to the CV; NaN
/// where unknown. `rows`: of an answer.
double moved_before(const Recording& signals, int cv, Eigen::Index row, Eigen::Index rows) {
  return signals.setpoints(row, cv) -
         signals.setpoints(std::max<Eigen::Index>(0, row - 1 - rows), cv);
}

/// Whether a CV steps just after its set-point, the same way, and by no more than that may do.
bool comes_with_setpoint(const Effect& effect, const ModelSpec& model, const Recording& signals) {
  const int cv = effect.place.cv;
  if (!effect.edit->jumps() || effect.onset == 0 || cv < 0 || cv >= signals.setpoints.cols())
    return false;
  const double moved = moved_before(signals, cv, effect.onset, rows_of_answer(model, cv));
  const double size = effect.coordinates.front().value;
  return moved * size > 0.0 && std::abs(moved) > kAnswersSetpoint * std::abs(size);
}

/// How often the set-point of an effect's CV moved by more than `least` at other times.
int other_moves(const Effect& effect, const ModelSpec& model, const Recording& signals,
                double least) {
  const int cv = effect.place.cv;
  const Eigen::Index rows = rows_of_answer(model, cv);
  int count = 0;
  for (Eigen::Index k = 1; k < signals.setpoints.rows(); ++k) {
    if (!(std::abs(moved_before(signals, cv, k, rows)) > least)) continue;
    if (k + rows < effect.onset || k > effect.onset) ++count;
    k += rows;  // the same move
  }
  return count;
}

bool is_own(const Effect& effect, int first) { return effect.place.aux == first + effect.place.cv; }

}  // namespace

bool may_name_setpoint(const Effect& effect, const ChannelTests& tests, int first) {
  const int cv = effect.place.cv;
  return !is_own(effect, first) || tests.setpoint(cv).wins || !tests.reject(tests.channels_to(cv));
}

bool own_setpoint_undecided(const ChannelTests& tests, int cv) {
  const RivalSignal& setpoint = tests.setpoint(cv);
  return setpoint.signal == cv && !setpoint.loses;
}

int moves(const Eigen::Ref<const Eigen::VectorXd>& signal) {
  int count = 0;
  double direction = 0.0;
  for (Eigen::Index k = 1; k < signal.size(); ++k) {
    const double step = signal(k) - signal(k - 1);
    const double now = step > 0.0 ? 1.0 : step < 0.0 ? -1.0 : 0.0;
    if (now != 0.0 && now != direction) ++count;
    direction = now;
  }
  return count;
}

const char* why_not_setpoint(const Named& named, bool alone, int moves, const ChannelTests& tests,
                             int first) {
  const Effect& effect = named.effect;
  if (is_own(effect, first)) return kOwnSetpoint;
  if (named.evidence < kStrongEvidence)
    return "a set-point acts through inputs: that it does more the data say too weakly";
  if (moves < kFewestSetpointMoves)
    return "the set-point moved too seldom: what disturbs the CV may go with it by chance";
  return alone && tests.setpoint(effect.place.cv).loses
             ? "the test of the channels explains clearly more by an error of theirs than the "
               "set-point does"
             : nullptr;
}

const char* why_not_step(const Effect& effect, const std::vector<Named>& all,
                         const ModelSpec& model, const Recording& signals) {
  if (!comes_with_setpoint(effect, model, signals)) return nullptr;
  const auto coming = std::count_if(all.begin(), all.end(), [&](const Named& named) {
    return named.effect.place == effect.place && comes_with_setpoint(named.effect, model, signals);
  });
  const double size = std::abs(effect.coordinates.front().value);
  const bool by_chance =
      coming <= 1 &&
      other_moves(effect, model, signals, kAnswersSetpoint * size) >= kFewestSetpointMoves;
  return by_chance
             ? nullptr
             : "the CV's set-point stepped just before, the same way: its loop's answer, as of "
               "a valve that slips, looks the same";
}

void add_own_setpoint(const Effect& effect, const ChannelTests& tests, int first,
                      Finding& finding) {
  const int cv = effect.place.cv;
  if (cv < 0 || effect.place.aux >= 0 || !cause_of(effect).acts_through_channels() ||
      !own_setpoint_undecided(tests, cv))
    return;
  const Subject rival{&causes::unmodelled_input(), {cv, -1, first + cv}};
  finding.rivals.insert(finding.rivals.begin(), {rival, kSetpointRarity, true});
  finding.confidence = 1.0 / (1.0 / finding.confidence + std::exp(-0.5 * kSetpointRarity));
}

}  // namespace mpm
