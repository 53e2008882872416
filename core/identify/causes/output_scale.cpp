#include <algorithm>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kOutputScaleName{"output_scale", "Scale of an output"};

/// All gains of one CV are off by the same ratio: the span of its sensor.
class OutputScale : public Cause {
 public:
  OutputScale() : Cause(kOutputScaleName) {}

  void apply(const Effect& effect, const Surroundings& surroundings,
             ModelSpec& model) const override {
    edit_channels(effect, surroundings, model);
  }

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const ModelSpec& model = outlook.model();
    for (int cv = 0; cv < model.cv_count; ++cv) {
      const auto channels =
          std::count_if(model.channels.begin(), model.channels.end(),
                        [cv](const ChannelSpec& channel) { return channel.cv == cv; });
      if (channels <= 1) continue;
      const double members = cost_of(static_cast<std::size_t>(model.cv_count));
      for (const ErrorOnset& begins : error_onsets(outlook.recording()))
        found.push_back(effect({cv}, {gain_ratio_coordinate()}, members + begins.cost, begins.row));
    }
  }

  [[nodiscard]] double rarity() const override { return kNoRarity; }

  [[nodiscard]] std::optional<bool> matters(const Effect& mine,
                                            const Tolerances& materiality) const override {
    return material_errors(mine, materiality) > 0;
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    const Parameter* ratio = finding.find(kGainRatio);
    std::string text = names.cv(finding.subject.place.cv).tag + " moves";
    if (ratio != nullptr) text += " " + compared(ratio->value);
    text += " than the model says, whatever input moves it";
    if (ratio != nullptr) text += " (" + interval_of(*ratio) + " of the ratio)";
    return text + ". That points to the span of its sensor. ";
  }
};

}  // namespace

const Cause& output_scale() {
  static const OutputScale cause;
  return cause;
}

}  // namespace mpm::causes
