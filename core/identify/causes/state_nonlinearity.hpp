#pragma once

#include <vector>

#include "core/identify/causes/cause.hpp"
#include "core/identify/causes/spread.hpp"

namespace mpm {

inline constexpr CauseName kStateNonlinearity{"state_nonlinearity", "Nonlinear dynamics", "term"};

/// A channel that may be nonlinear inside, and how its input and its CV move.
struct StatePlace {
  const ChannelSpec* channel;
  Spread input, cv;
};

/// A nonlinear term between a channel's input and its output; one per channel.
class StateNonlinearity : public Cause {
 public:
  explicit StateNonlinearity(const char* term) : Cause(kStateNonlinearity, term) {}
  [[nodiscard]] double rarity() const override;
  [[nodiscard]] bool is_curve() const override { return true; }
  [[nodiscard]] bool settles_channel(const Effect& mine) const override;

 protected:
  /// The model's channels that are not tanks yet, those that never settle too if asked for.
  [[nodiscard]] static std::vector<StatePlace> state_places(const Outlook& outlook,
                                                            bool integrating = false);
  /// What a term is picked from.
  [[nodiscard]] static double members_cost(const Outlook& outlook);
};

}  // namespace mpm
