#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/input_block.hpp"
#include "core/identify/causes/valve.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kStictionName{"stiction", "Sticking valve"};

constexpr Quantity kBand{"band", Form::kPlain, Unit::kInput};
constexpr Quantity kJump{"jump", Form::kPlain, Unit::kInput};

/// Variant of a valve that sticks again after every slip (Stiction::slips_once).
constexpr int kSlipsOnce = 1;

/// Bands to begin a fit from, as shares of the input's range, and jumps as shares of the band.
constexpr double kBands[] = {0.02, 0.04, 0.08, 0.15, 0.25};
constexpr double kJumps[] = {0.3, 0.65, 1.0};
/// The same where sticking over most of the range hides what the channel is.
constexpr double kWideBands[] = {0.1, 0.2, 0.35, 0.5, 0.7};
constexpr double kWideJumps[] = {0.1, 0.4, 0.8};
constexpr double kDelayTakenForSticking = 0.6;  ///< of the removable dead time
/// s.d. of band and jump, as shares of the range, and what they never pass.
constexpr double kStictionUsualWidth = 0.15, kWideWidth = 0.5;
constexpr double kLeastBand = 1e-4, kMostWidth = 1.5;
/// s.d. of the gain ratio where nothing is known of it.
constexpr double kOpenGain = 1.0;
/// Of the band, steps of the finite differences: the jump stays within the band.
constexpr double kStictionStep = 0.05;

/// The closer look: widths in percent of the one given, and jumps as shares of them.
constexpr int kNarrowest = 80, kWidest = 165, kPercentStep = 5;
constexpr double kAllJumps[] = {0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0};

/// A valve rests until its command has moved by `band`, then jumps by `jump` (Choudhury 2005). It
/// sticks for all CVs alike.
class StickingValve : public InputBlockCause {
 public:
  StickingValve() : InputBlockCause(kStictionName) {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    if (effect.find(kDeadTimeError)) edit_channels(effect, surroundings, model);
    InputBlockCause::apply(effect, surroundings, model);
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    for (const BlockPlace& at : curve_places(outlook)) {
      if (!at.whole_input) continue;
      const double range = at.input.range();
      const double cost = cost_of(2 * at.members);
      for (const MeasuredSticking& measured : outlook.recording().sticking)
        if (measured.input == at.place.input) {
          const Stiction& shown = measured.valve;
          Effect valve =
              effect(at.place,
                     widths(shown.band, shown.jump / shown.band, kStictionUsualWidth, range), cost);
          valve.variant = shown.slips_once ? kSlipsOnce : 0;
          found.push_back(std::move(valve));
        }
      for (const ErrorOnset& begins : block_onsets(outlook))
        for (const double share : kBands)
          for (const double jump : kJumps)
            for (const int variant : {0, kSlipsOnce}) {
              Effect valve =
                  effect(at.place, widths(share * range, jump, kStictionUsualWidth, range),
                         cost + begins.cost, begins.row);
              valve.variant = variant;
              found.push_back(std::move(valve));
            }
      if (outlook.cvs_of(at.place.input).size() > 1) continue;
      for (const ChannelSpec& channel : outlook.model().channels)
        if (channel.input == at.place.input)
          with_linear_part(channel, at, outlook.sample_time_s(), cost, found);
    }
  }

  [[nodiscard]] bool settles_channel(const Effect& mine) const override {
    return mine.find(kGainRatio) != nullptr;
  }

  /// The valve's own measured position.
  [[nodiscard]] bool borne_out(const Effect& mine, const Problem& problem) const override {
    const auto& sticking = problem.recording().sticking;
    return std::any_of(sticking.begin(), sticking.end(), [&](const MeasuredSticking& measured) {
      return measured.input == mine.place.input;
    });
  }
  [[nodiscard]] std::vector<Effect> closer_look(const Effect& mine,
                                                const std::vector<Effect>& tried) const override {
    return sticking_near(mine, mine.value(kBand, 0.0), tried);
  }
  [[nodiscard]] Stepping stepping(const Effect& mine) const override {
    return width_stepping(mine);
  }
  [[nodiscard]] Effect neighbour(const Effect& mine, double reach, int index,
                                 const Problem&) const override {
    return other_width(mine, reach, index);
  }
  [[nodiscard]] int kinked_numbers() const override { return 2; }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Place& place = finding.subject.place;
    std::string text = "The valve of " + names.source(place).tag + " sticks";
    if (const Parameter* band = finding.find(kBand))
      text += ": it rests until its command has moved " + names.in_source(band->value, place) +
              " (" + interval_of(*band) + ")";
    if (const Parameter* jump = finding.find(kJump))
      text += ", then jumps by " + names.in_source(jump->value, place) + " (" + interval_of(*jump) +
              ")";
    return text + ". ";
  }

 protected:
  [[nodiscard]] InputBlock block(const Effect& effect, const Surroundings&) const override {
    return Stiction{effect.value(kBand, 0.0), effect.value(kJump, 0.0),
                    effect.variant == kSlipsOnce};
  }

 private:
  static std::vector<Coordinate> widths(double band, double jump, double usual, double range) {
    return {{.quantity = &kBand,
             .value = band,
             .prior_mean = 0.0,
             .prior_sd = usual * range,
             .step = kStictionStep * band,
             .low = kLeastBand * range,
             .high = kMostWidth * range},
            {.quantity = &kJump,
             .value = jump * band,
             .prior_mean = 0.0,
             .prior_sd = usual * range,
             .step = -kStictionStep * band,
             .low = 0.0,
             .high = kMostWidth * range}};
  }

  /// A valve that sticks over most of its range hides what the channel is: a model fitted to such
  /// data has taken the sticking for dead time. Then both are to be found together.
  void with_linear_part(const ChannelSpec& channel, const BlockPlace& at, double sample_time_s,
                        double cost, std::vector<Effect>& found) const {
    const double range = at.input.range();
    const double removable = removable_samples(channel, sample_time_s);
    for (const double share : kWideBands)
      for (const double jump : kWideJumps)
        for (const double delay : {0.0, -kDelayTakenForSticking * removable}) {
          std::vector<Coordinate> coordinates = widths(share * range, jump, kWideWidth, range);
          coordinates.push_back(gain_ratio_coordinate());
          coordinates.back().prior_sd = kOpenGain;
          coordinates.push_back(time_constant_coordinate(0.0));
          coordinates.push_back(dead_time_coordinate(delay, removable));
          found.push_back(effect(at.place, std::move(coordinates), cost));
        }
  }
};

}  // namespace

Stepping width_stepping(const Effect& mine) {
  return {{0.3, 0.15, 0.075, 0.0375, 0.01875, 0.009375},
          2 * static_cast<int>(mine.coordinates.size())};
}

Effect other_width(const Effect& mine, double reach, int index) {
  Effect other = mine;
  Coordinate& c = other.coordinates[static_cast<std::size_t>(index / 2)];
  const double factor = 1.0 + reach;
  c.value = std::clamp(c.value * (index % 2 == 0 ? factor : 1.0 / factor), c.low, c.high);
  return other;
}

std::vector<Effect> sticking_near(const Effect& mine, double width,
                                  const std::vector<Effect>& tried) {
  const auto like = std::find_if(tried.begin(), tried.end(), [&](const Effect& effect) {
    return effect.edit == &stiction() && effect.place.input == mine.place.input &&
           (effect.onset > 0) == (mine.onset > 0);
  });
  std::vector<Effect> found;
  if (like == tried.end()) return found;
  for (int percent = kNarrowest; percent < kWidest; percent += kPercentStep) {
    const double factor = 0.01 * percent;
    for (const double jump : kAllJumps)
      for (const int variant : {0, kSlipsOnce}) {
        Effect effect = *like;
        effect.variant = variant;
        effect.onset = mine.onset;
        effect.coordinates[0].value = factor * width;
        effect.coordinates[1].value = jump * factor * width;
        effect.coordinates[0].step = kStictionStep * factor * width;
        effect.coordinates[1].step = -kStictionStep * factor * width;
        found.push_back(std::move(effect));
      }
  }
  return found;
}

const Cause& stiction() {
  static const StickingValve cause;
  return cause;
}

}  // namespace mpm::causes
