#pragma once

#include <functional>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/evidence/free_run_residuals.hpp"
#include "core/identify/fit/effect.hpp"

namespace mpm {

/// The calibrated test of the channels: of the given model, and of what the plant is said to have
/// been, with the same inputs and set-points behind them; and, beside it, the monitor's with its
/// nonlinear test.
struct Witness {
  const ChannelTests& given;
  const ChannelTests& given_nonlinear;
  std::function<ChannelTests(const std::vector<Stage>&, OwnPast)> of;
};

/// What it says of a repair, ever more in its favour.
enum class Confirmation {
  kNone,          ///< it sees no less wrong
  kLess,          ///< clearly less
  kTrace,         ///< hardly anything of what it had seen beyond doubt and that matters
  kNothing,       ///< nothing any more
  kNothingOfAll,  ///< nothing of what it had seen beyond doubt and that matters
};

/// Asked of the channels that an effect changes, where the test saw most, on the given and on the
/// repaired model. A channel that is said to do nothing, for its actuator is stuck, must indeed do
/// nothing. A sticking valve swings by itself, which no repair follows for long: that the test sees
/// hardly anything more, or clearly less and not clearly more surely, is enough.
[[nodiscard]] Confirmation confirmation(const Effect& effect, const ModelSpec& model,
                                        int model_inputs, const ChannelTests& before,
                                        const ChannelTests& after);

/// Whether a finding says how far a channel is off, so that the test's word alone may be enough: no
/// curve or valve, which takes more movement to tell from another, and no channel that may do
/// nothing at all, for whatever is missing from the data looks like that.
[[nodiscard]] bool is_channel_error(const Finding& finding);

}  // namespace mpm
