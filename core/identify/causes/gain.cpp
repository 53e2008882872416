#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"

namespace mpm::causes {
namespace {

constexpr CauseName kGainName{"gain", "Gain"};

/// A channel's gain is another one than the model's.
class Gain : public SingleChannelError {
 public:
  Gain() : SingleChannelError(kGainName) {}

  void propose(const Outlook& outlook, std::vector<Effect>& found) const override {
    const double members = cost_of(outlook.model().channels.size());
    for (const ChannelSpec& channel : outlook.model().channels) {
      if (!has_own_gain(channel)) continue;
      for (const ErrorOnset& begins : error_onsets(outlook.recording()))
        found.push_back(effect(place_of(channel), {gain_ratio_coordinate()}, members + begins.cost,
                               begins.row));
    }
  }

  [[nodiscard]] std::string sentence(const Finding& finding,
                                     const SignalNames& names) const override {
    return gain_sentence(finding, names);
  }
};

}  // namespace

const Cause& gain() {
  static const Gain cause;
  return cause;
}

}  // namespace mpm::causes
