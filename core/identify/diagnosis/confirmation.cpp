#include "core/identify/diagnosis/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/diagnosis/calibration.hpp"
#include "core/identify/diagnosis/nameable.hpp"
#include "core/identify/fit/quantity.hpp"

namespace mpm {
namespace {

struct Seen {
  double wrong = 0.0;    ///< the most
  double p_value = 1.0;  ///< the smallest, times their number
  bool matters = false;  ///< some of it surely
};

Seen seen(const ChannelTests& tests, const std::vector<std::pair<int, int>>& channels) {
  Seen most;
  double smallest = 1.0, tested = 0.0;
  for (const auto& [cv, input] : channels) {
    const std::optional<double> p = tests.p_value(cv, input);
    if (!p) continue;
    most.wrong = std::max(most.wrong, tests.wrong(cv, input));
    most.matters = most.matters || tests.harmless_p_value(cv, input) <= kSurelyMatters;
    smallest = std::min(smallest, *p);
    tested += 1.0;
  }
  most.p_value = std::min(1.0, smallest * tested);
  return most;
}

}  // namespace

Confirmation confirmation(const Effect& effect, const ModelSpec& model, int model_inputs,
                          const ChannelTests& before, const ChannelTests& after) {
  const std::vector<std::pair<int, int>> channels = channels_of(effect, model, model_inputs);
  const Seen was = seen(before, channels), is = seen(after, channels);
  if (effect.edit == &causes::stiction()) {
    const bool less =
        is.p_value > std::pow(was.p_value, kMoreSurely) && is.wrong < kClearlyLessSeen * was.wrong;
    return less || is.p_value > kHardlySees ? Confirmation::kNothing : Confirmation::kNone;
  }
  if (effect.edit == &causes::input_stuck())
    return is.p_value > kStillMoves ? Confirmation::kNothing : Confirmation::kNone;
  if (was.p_value > kSeesNothing) return Confirmation::kLess;  // believed without its word
  const bool sure = was.p_value < kBeyondDoubt && was.matters;
  if (is.p_value > kSeesNothing) return sure ? Confirmation::kNothingOfAll : Confirmation::kNothing;
  if (sure && is.p_value > kHardlySees && is.wrong < kHardlyAny * was.wrong)
    return Confirmation::kTrace;
  return is.wrong < kClearlyLessSeen * was.wrong ? Confirmation::kLess : Confirmation::kNone;
}

bool is_channel_error(const Finding& finding) {
  const Cause& cause = *finding.subject.cause;
  const Parameter* gain = finding.find(kGainRatio);
  return cause.acts_through_channels() && !cause.is_curve() && !cause.is_input_block() &&
         (gain == nullptr || gain->low > 0.0);
}

}  // namespace mpm
