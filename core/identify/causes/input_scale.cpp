#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kInputScaleName{"input_scale", "Scale of an input"};

/// Gains of so many CVs at most are meant where a scale and a gain cancel in another.
constexpr std::size_t kMostGainsInstead = 2;

/// All gains of one input are off by the same ratio: its actuator, or its flow meter.
class InputScale : public Cause {
 public:
  InputScale() : Cause(kInputScaleName) {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    edit_channels(effect, surroundings, model);
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double members = cost_of(static_cast<std::size_t>(outlook.inputs()));
    for (int input = 0; input < outlook.inputs(); ++input) {
      if (outlook.cvs_of(input).size() <= 1) continue;
      for (const ErrorOnset& begins : error_onsets(outlook.recording()))
        found.push_back(
            effect({-1, input}, {gain_ratio_coordinate()}, members + begins.cost, begins.row));
    }
  }

  [[nodiscard]] double rarity() const override { return kNoRarity; }

  [[nodiscard]] std::optional<bool> matters(const Effect& mine,
                                            const Tolerances& materiality) const override {
    return material_errors(mine, materiality) > 0;
  }

  /// A scale of a whole input together with a gain that takes it back in one CV says in two
  /// findings what gains of the other CVs say too, with fewer channels wrong: those are meant.
  [[nodiscard]] std::vector<Rewrite> rewrites(std::size_t mine, const std::vector<Effect>& accepted,
                                              const Problem& problem,
                                              const Tolerances& materiality) const override {
    const Effect& scale = accepted[mine];
    const double ratio = scale.value(kGainRatio, 1.0);
    std::vector<Rewrite> rewrites;
    for (std::size_t g = 0; g < accepted.size(); ++g) {
      if (accepted[g].edit != &gain() || accepted[g].place.input != scale.place.input ||
          accepted[g].onset != scale.onset)
        continue;
      const double left = ratio * accepted[g].value(kGainRatio, 1.0) - 1.0;
      std::vector<int> others = touched(scale, problem);
      std::erase(others, accepted[g].place.cv);
      if (std::abs(left) > materiality.gain || others.empty() || others.size() > kMostGainsInstead)
        continue;
      Rewrite rewrite{{std::min(mine, g), std::max(mine, g)}, {}};
      for (const int cv : others) {
        Effect effect = accepted[g];
        effect.place.cv = cv;
        effect.coordinates[0].value = ratio;
        rewrite.with.push_back(std::move(effect));
      }
      rewrites.push_back(std::move(rewrite));
    }
    return rewrites;
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const std::string& source = names.source(finding.subject.place).tag;
    const Parameter* ratio = finding.find(kGainRatio);
    std::string text = "Every CV answers " + source;
    if (ratio != nullptr) text += " " + compared(ratio->value);
    text += " than the model says";
    if (ratio != nullptr) text += " (" + interval_of(*ratio) + " of the ratio)";
    return text + ". That points to the actuator or the flow meter of " + source +
           ", not to one channel. ";
  }
};

}  // namespace

const Cause& input_scale() {
  static const InputScale cause;
  return cause;
}

}  // namespace mpm::causes
