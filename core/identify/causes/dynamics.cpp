#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/dead_time.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kDynamicsName{"dynamics", "Dynamics"};

/// Logs of time constant ratios to begin a fit from.
constexpr double kDynamicsStarts[] = {-0.3, 0.0, 0.4};

/// Two or more errors of one channel: gain, time constant, dead time.
class Dynamics : public Cause {
 public:
  Dynamics() : Cause(kDynamicsName) {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    edit_channels(effect, surroundings, model);
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double members = cost_of(outlook.model().channels.size());
    for (const ChannelSpec& channel : outlook.model().channels) {
      const auto add = [&](std::vector<Coordinate> coordinates) {
        found.push_back(effect(place_of(channel), std::move(coordinates), members));
      };
      const bool gain = has_own_gain(channel);
      for (const double start : kDynamicsStarts)
        if (gain) add({gain_ratio_coordinate(), time_constant_coordinate(start)});
      const double removable = removable_samples(channel, outlook.sample_time_s());
      for (const double start : dead_time_starts(removable)) {
        const Coordinate delay = dead_time_coordinate(start, removable);
        add({time_constant_coordinate(0.0), delay});
        if (!gain) continue;
        add({gain_ratio_coordinate(), delay});
        add({gain_ratio_coordinate(), time_constant_coordinate(0.0), delay});
      }
    }
  }

  [[nodiscard]] double rarity() const override { return kNoRarity; }

  [[nodiscard]] std::optional<bool> matters(const Effect& mine,
                                            const Tolerances& materiality) const override {
    return material_errors(mine, materiality) > 1;
  }

  [[nodiscard]] const Cause* together_with_others() const override { return this; }

  [[nodiscard]] bool may_be_nothing(const Finding& finding) const override {
    return std::all_of(finding.parameters.begin(), finding.parameters.end(), includes_nothing);
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return gain_sentence(finding, names) + time_constant_sentence(finding, names) +
           dead_time_sentence(finding, names);
  }
};

}  // namespace

const Cause& dynamics() {
  static const Dynamics cause;
  return cause;
}

}  // namespace mpm::causes
