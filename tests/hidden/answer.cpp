#include "tests/hidden/answer.hpp"

#include <algorithm>

namespace mpm::hidden {
namespace {

long channels_of_input(const ModelSpec& model, int input) {
  return std::count_if(model.channels.begin(), model.channels.end(),
                       [&](const ChannelSpec& channel) { return channel.input == input; });
}

long channels_of_cv(const ModelSpec& model, int cv) {
  return std::count_if(model.channels.begin(), model.channels.end(),
                       [&](const ChannelSpec& channel) { return channel.cv == cv; });
}

/// One gain error of one channel goes by three names.
struct Gain {
  const Cause* cause;
  int cv, input;
};

/// The channel that a scale means, where it means only one.
Gain as_channel(const ModelSpec& model, Gain gain) {
  const bool input = gain.cause == &causes::input_scale();
  const bool output = gain.cause == &causes::output_scale();
  if ((input && channels_of_input(model, gain.input) != 1) ||
      (output && channels_of_cv(model, gain.cv) != 1))
    return gain;
  for (const ChannelSpec& channel : model.channels)
    if ((input && channel.input == gain.input) || (output && channel.cv == gain.cv))
      return {&causes::gain(), channel.cv, channel.input};
  return gain;
}

bool is_part_of_dynamics(const Cause* cause) {
  return cause == &causes::gain() || cause == &causes::time_constant() ||
         cause == &causes::dead_time();
}

}  // namespace

Match match(const HiddenCase& hidden, const TrueEffect& truth, const Subject& subject) {
  if (!truth.cause) return Match::kOther;
  const Gain wanted = as_channel(hidden.model, {truth.cause, truth.place.cv, truth.place.input});
  const Gain given =
      as_channel(hidden.model, {subject.cause, subject.place.cv, subject.place.input});
  if (!same_name(wanted.cause, given.cause)) return Match::kOther;
  const bool place =
      wanted.cv == given.cv && wanted.input == given.input && truth.place.aux == subject.place.aux;
  return place ? Match::kPlace : Match::kCause;
}

Answer answer_to(const HiddenCase& hidden, const TrueEffect& truth,
                 const std::vector<Finding>& findings) {
  Answer best;
  for (const Finding& finding : findings) {
    const Match how = match(hidden, truth, finding.subject);
    if (how > best.match) best = {how, {&finding}};
  }
  if (truth.cause != &causes::dynamics() || best.match == Match::kPlace) return best;
  Answer parts{Match::kPlace, {}};
  for (const Finding& finding : findings)
    if (is_part_of_dynamics(finding.subject.cause) && finding.subject.place == truth.place)
      parts.findings.push_back(&finding);
  return parts.findings.size() >= 2 ? parts : best;
}

}  // namespace mpm::hidden
