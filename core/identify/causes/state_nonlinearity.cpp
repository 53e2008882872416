#include "core/identify/causes/state_nonlinearity.hpp"

#include <algorithm>

#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm {

double StateNonlinearity::rarity() const { return kStateRarity; }

bool StateNonlinearity::settles_channel(const Effect& mine) const {
  return mine.find(kGainRatio) != nullptr;
}

std::vector<StatePlace> StateNonlinearity::state_places(const Outlook& outlook, bool integrating) {
  const Recording& recording = outlook.recording();
  std::vector<StatePlace> places;
  for (const ChannelSpec& channel : outlook.model().channels) {
    if (channel.input >= outlook.inputs()) continue;
    const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
    if (!has_own_gain(channel)) continue;
    if (transfer != nullptr && transfer->integrating && !integrating) continue;
    const std::optional<Spread> input = spread_of(recording.inputs.col(channel.input));
    const std::optional<Spread> cv = spread_of(recording.cvs.col(channel.cv));
    if (input && cv) places.push_back({&channel, *input, *cv});
  }
  return places;
}

double StateNonlinearity::members_cost(const Outlook& outlook) {
  constexpr std::size_t kTerms = 3;
  return cost_of(kTerms * outlook.model().channels.size());
}

}  // namespace mpm
