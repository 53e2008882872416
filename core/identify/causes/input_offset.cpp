#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/identify/causes/actuator_moments.hpp"
#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/identify/causes/unmodelled_input.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kInputOffsetName{"input_offset", "Offset of an actuator"};

constexpr Quantity kSize{"size", Form::kPlain, Unit::kInput};

/// Moments that are looked at more closely; one is told from others some rows away.
constexpr std::size_t kInputOffsetMoments = 8;
constexpr std::size_t kInputOffsetRowsPerMoment = 4;
/// s.d. of the size, and a step of its finite difference, as shares of the input's range.
constexpr double kInputOffsetUsualSize = 0.3, kInputOffsetSizeStep = 0.01;
/// Load disturbances come in through like dynamics as often as actuators shift: where only one CV
/// answers, the shape of the onset must speak for the actuator by itself, 2 ln of odds. And what
/// wanders looks like steps of this and that.
constexpr double kOneCvOnly = 30.0;
constexpr double kWandering = 20.0;

/// A signal has moved along with an onset where so much of its variance is between before and
/// after.
constexpr double kMovedAlong = 0.3;

/// Of the first `columns` the one that moved most from before the onset to after it; -1: none
/// did so clearly.
int moves_along(const Eigen::MatrixXd& signals, Eigen::Index columns, Eigen::Index onset) {
  int best = -1;
  double most = kMovedAlong;
  for (Eigen::Index a = 0; a < columns; ++a) {
    double count[2] = {}, sum[2] = {}, square = 0.0;
    double origin = std::numeric_limits<double>::quiet_NaN();  // the first known value
    for (Eigen::Index k = 0; k < signals.rows(); ++k) {
      if (!std::isfinite(signals(k, a))) continue;
      if (!std::isfinite(origin)) origin = signals(k, a);
      const double value = signals(k, a) - origin;
      ++count[k >= onset];
      sum[k >= onset] += value;
      square += value * value;
    }
    if (count[0] == 0.0 || count[1] == 0.0) continue;
    const double all = sum[0] + sum[1];
    const double total = square - all * all / (count[0] + count[1]);
    const double within = square - sum[0] * sum[0] / count[0] - sum[1] * sum[1] / count[1];
    const double share = total > 0.0 ? 1.0 - within / total : 0.0;
    if (share > most) {
      most = share;
      best = static_cast<int>(a);
    }
  }
  return best;
}

/// An actuator is open by more than its command from a moment on: it leaks, or its zero has
/// shifted. An offset that is always there is a level of the CVs, which a model leaves free; it
/// is never taken for one.
class InputOffsetCause : public InputBlockCause {
 public:
  InputOffsetCause() : InputBlockCause(kInputOffsetName) {}

  [[nodiscard]] bool knows_onset() const override { return true; }
  [[nodiscard]] bool has_onset_parameter() const override { return true; }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const auto samples = static_cast<std::size_t>(outlook.problem.samples());
    const double cost = cost_of(static_cast<std::size_t>(outlook.inputs())) +
                        cost_of(samples / kInputOffsetRowsPerMoment);
    for (const BlockPlace& at : block_places(outlook)) {
      if (!at.whole_input) continue;
      const int input = at.place.input;
      const double range = at.input.range();
      const double shared = outlook.cvs_of(input).size() > 1 ? 0.0 : kOneCvOnly;
      for (const ActuatorMoment& moment : offset_moments(outlook, input, kInputOffsetMoments))
        found.push_back(effect({-1, input},
                               {{.quantity = &kSize,
                                 .value = moment.value,
                                 .prior_sd = kInputOffsetUsualSize * range,
                                 .step = kInputOffsetSizeStep * range}},
                               cost + shared + kWandering, moment.onset));
    }
  }

  /// A load that comes in there, or a change of what the input feeds, does the same to every CV:
  /// which of the plants from first principles of tests/foreign/physical.py show.
  [[nodiscard]] double alike() const override { return 1.0; }

  /// The input need not move for it to show: it is a load on its CVs.
  [[nodiscard]] bool acts_through_channels() const override { return false; }

  /// What the input feeds may have changed instead, and a signal that the model leaves out have
  /// seen it: the one that moved most at that moment, acting on the same CVs. Set-points, which
  /// stand behind the aux signals, are none.
  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem& problem,
                                              const Tolerances&) const override {
    const Effect& offset = accepted[mine];
    const ModelSpec& model = problem.model();
    const Recording& recording = problem.recording();
    const int aux = moves_along(recording.aux, first_setpoint(recording), offset.onset);
    if (aux < 0) return {};
    Rewrite rewrite{{mine}, {}};
    for (const ChannelSpec& channel : model.channels) {
      if (channel.input != offset.place.input) continue;
      const Place place{channel.cv, -1, aux};
      const bool known = std::any_of(accepted.begin(), accepted.end(), [&](const Effect& effect) {
        return effect.edit == &unmodelled_input() && effect.place == place;
      });
      if (known) continue;
      if (const auto effect = unmodelled_input_at(
              problem, place, 1, slowest_time_constant_s(channel, model.sample_time_s),
              removable_dead_time_s(channel, model.sample_time_s)))
        rewrite.with.push_back(*effect);
    }
    if (rewrite.with.empty()) return {};
    return {rewrite};
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    const std::string& tag = names.source(place).tag;
    const Parameter* size = finding.find(kSize);
    std::string text =
        tag + " acts as if it were " +
        (size == nullptr ? "offset"
                         : names.in_source(std::abs(size->value), place) +
                               (size->value < 0.0 ? " lower" : " higher") + " (size " +
                               interval_of(*size, names.source(place).unit) + ")");
    text +=
        ": its actuator leaks, its zero has shifted, or what it feeds has changed, which "
        "acts alike. ";
    const int cv = only_cv(names.model, place.input);
    if (cv >= 0)
      text += "Only " + names.cv(cv).tag +
              " answers it, so that a disturbance that comes in the same way looks the same. ";
    return text;
  }

 protected:
  [[nodiscard]] bool may_stand_beside(const InputBlock& there) const override {
    return std::holds_alternative<Polynomial>(there) || std::holds_alternative<TwoSided>(there) ||
           std::holds_alternative<Product>(there) || std::holds_alternative<Saturation>(there);
  }

  [[nodiscard]] InputBlock block(const Effect& effect,
                                 const Surroundings& surroundings) const override {
    return InputOffset{effect.value(kSize, 0.0), since_s(effect, surroundings)};
  }
};

}  // namespace

const Cause& input_offset() {
  static const InputOffsetCause cause;
  return cause;
}

}  // namespace mpm::causes
