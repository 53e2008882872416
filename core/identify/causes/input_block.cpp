#include "core/identify/causes/input_block.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/identify/causes/catalog.hpp"
#include "core/identify/causes/channel_error.hpp"
#include "core/identify/causes/priors.hpp"

namespace mpm {
namespace {

bool is_offset(const InputBlock& block) { return std::holds_alternative<InputOffset>(block); }

}  // namespace

void InputBlockCause::apply(const Effect& effect, const Surroundings& surroundings,
                            ModelSpec& model) const {
  const InputBlock block = this->block(effect, surroundings);
  std::optional<InputBlock>& whole =
      model.input_blocks[static_cast<std::size_t>(effect.place.input)];
  // Of two before the whole input the actuator's offset stays there, and the curve goes before each
  // channel instead, which is the same.
  std::optional<InputBlock> before_each;
  if (effect.place.cv >= 0) {
    before_each = block;
  } else if (!whole || is_offset(block) == is_offset(*whole)) {
    whole = block;
  } else {
    before_each = is_offset(block) ? std::exchange(whole, block) : block;
  }
  if (!before_each) return;
  for (ChannelSpec& channel : model.channels)
    if (channel.input == effect.place.input &&
        (effect.place.cv < 0 || channel.cv == effect.place.cv))
      channel.input_block = before_each;
}

bool InputBlockCause::goes_with(const Effect& accepted, const Effect& mine) const {
  const auto goes_before = [](const Effect& first, const Effect& then) {
    return first.edit == &causes::input_offset() && cause_of(then).is_curve();
  };
  if (cause_of(accepted).is_input_block() && accepted.place.input == mine.place.input &&
      !goes_before(accepted, mine) && !goes_before(mine, accepted))
    return false;
  return Cause::goes_with(accepted, mine);
}

bool InputBlockCause::may_stand_beside(const InputBlock& there) const {
  return is_curve() && is_offset(there);
}

std::vector<BlockPlace> InputBlockCause::block_places(const Outlook& outlook) const {
  const ModelSpec& model = outlook.model();
  const std::size_t members = static_cast<std::size_t>(outlook.inputs()) + model.channels.size();
  std::vector<BlockPlace> places;
  for (int input = 0; input < outlook.inputs(); ++input) {
    const std::optional<InputBlock>& whole = model.input_blocks[static_cast<std::size_t>(input)];
    if (whole && !may_stand_beside(*whole)) continue;
    const std::optional<Spread> spread = spread_of(outlook.recording().inputs.col(input));
    const std::vector<int> cvs = outlook.cvs_of(input);
    if (!spread || cvs.empty()) continue;
    const auto add = [&](int cv, bool whole_input) {
      const bool taken = std::any_of(
          model.channels.begin(), model.channels.end(), [&](const ChannelSpec& channel) {
            return channel.input == input && (cv < 0 || channel.cv == cv) &&
                   (!has_own_gain(channel) ||
                    (channel.input_block && (whole || !may_stand_beside(*channel.input_block))));
          });
      if (!taken) places.push_back({{cv, input}, *spread, whole_input, members});
    };
    add(cvs.size() > 1 ? -1 : cvs[0], true);
    if (cvs.size() > 1)
      for (const int cv : cvs) add(cv, false);
  }
  return places;
}

std::vector<BlockPlace> InputBlockCause::curve_places(const Outlook& outlook, int levels) const {
  std::vector<BlockPlace> places = block_places(outlook);
  std::erase_if(places, [levels](const BlockPlace& at) { return at.input.levels() < levels; });
  return places;
}

std::vector<ErrorOnset> InputBlockCause::block_onsets(const Outlook& outlook) {
  return error_onsets(outlook.recording(), false);
}

Coordinate InputBlockCause::plain_ratio(const Quantity& quantity) {
  return {.quantity = &quantity,
          .value = 1.0,
          .prior_mean = 1.0,
          .prior_sd = 0.25,
          .step = 0.01,
          .low = -20.0,
          .high = 20.0};
}

Coordinate InputBlockCause::bending(const Quantity& quantity, double sd) {
  return {.quantity = &quantity,
          .prior_sd = sd,
          .step = 0.05 * sd,
          .low = -kUnbounded,
          .high = kUnbounded};
}

std::vector<Rewrite> InputBlockCause::as_gain(std::size_t mine, const std::vector<Effect>& accepted,
                                              double ratio, const Problem& problem) {
  Effect plain = accepted[mine];
  const std::vector<int> cvs = touched(plain, problem);
  plain.edit = cvs.size() == 1 ? &causes::gain() : &causes::input_scale();
  if (cvs.size() == 1) plain.place.cv = cvs.front();
  plain.coordinates = {gain_ratio_coordinate()};
  plain.coordinates.front().value = ratio;
  return {{{mine}, {plain}}};
}

double InputBlockCause::since_s(const Effect& effect, const Surroundings& surroundings) {
  if (effect.onset == 0) return -std::numeric_limits<double>::infinity();
  return surroundings.start_s + static_cast<double>(effect.onset) * surroundings.sample_time_s;
}

int InputBlockCause::only_cv(const ModelSpec& model, int input) {
  int only = -1;
  for (const ChannelSpec& channel : model.channels) {
    if (channel.input != input) continue;
    if (only >= 0) return -1;
    only = channel.cv;
  }
  return only;
}

std::string InputBlockCause::target(const Finding& finding, const SignalNames& names) {
  const int cv = finding.subject.place.cv;
  return cv >= 0 ? names.cv(cv).tag : "the plant";
}

}  // namespace mpm
