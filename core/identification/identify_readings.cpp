#include "core/identification/identify_readings.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/identification/identify_long.hpp"
#include "core/identify/fit/condense.hpp"
#include "core/identify/fit/readings.hpp"
#include "core/model/linear_model.hpp"

namespace mpm {
namespace {

IdentificationSettings of_cv(const IdentificationSettings& settings, int cv) {
  IdentificationSettings part = settings;
  std::erase_if(part.hints, [cv](const ChannelHint& hint) { return hint.cv != cv; });
  for (ChannelHint& hint : part.hints) hint.cv = 0;
  return part;
}

// At the operating point of the whole's inputs.
double level_of(const ModelSpec& part, const Eigen::VectorXd& inputs) {
  double level = part.output_origin(0);
  const Eigen::MatrixXd gain = LinearModel(part).steady_gain();
  for (const ChannelSpec& channel : part.channels) {
    const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
    if (transfer != nullptr && transfer->integrating) continue;
    level += gain(0, channel.input) * (inputs(channel.input) - part.input_origin(channel.input));
  }
  return level;
}

void put_in(const Identification& part, int cv, Identification& whole) {
  for (ChannelAnswer& answer : whole.channels) {
    if (answer.cv != cv || answer.left_out != LeftOut::kReadSeldom) continue;
    answer = part.channels[static_cast<std::size_t>(answer.input)];
    answer.cv = cv;
  }
  for (ChannelSpec channel : part.model.channels) {
    channel.cv = cv;
    whole.model.channels.push_back(std::move(channel));
  }
  std::stable_sort(whole.model.channels.begin(), whole.model.channels.end(),
                   [](const ChannelSpec& a, const ChannelSpec& b) {
                     return std::tie(a.cv, a.input) < std::tie(b.cv, b.input);
                   });
  whole.model.output_origin(cv) = level_of(part.model, whole.model.input_origin);
  CvAnswer& answer = whole.cvs[static_cast<std::size_t>(cv)];
  const Eigen::Index every = answer.read_every;
  answer = part.cvs.front();
  answer.cv = cv;
  answer.read_every = every;
  whole.longest_lag_s = std::max(whole.longest_lag_s, part.longest_lag_s);
}

}  // namespace

void identify_readings(const Recording& recording, const IdentificationSettings& settings,
                       Identification& whole) {
  const auto seldom = [&](int cv) {
    return std::any_of(whole.channels.begin(), whole.channels.end(), [cv](const auto& answer) {
      return answer.cv == cv && answer.left_out == LeftOut::kReadSeldom;
    });
  };
  for (const Readings& readings : readings_of(recording)) {
    for (const int cv : readings.cvs) {
      if (readings.every == 1.0 || !seldom(cv)) continue;
      const Recording rows = averaged(of_cvs(recording, {cv}), readings.every, readings.offsets);
      if (rows.samples() < needed_rows(rows.inputs.cols())) continue;
      put_in(identify_long(rows, of_cv(settings, cv)).identification, cv, whole);
    }
  }
}

}  // namespace mpm
