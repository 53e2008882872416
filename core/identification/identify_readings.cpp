#include "core/identification/identify_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/identification/calibration.hpp"
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

/// A mean is not all of what a quick channel makes of its input: again on the CV as it would be if
/// it were, by what the model before says, until that changes it by little (a model that swings
/// holds at its own sample time alone).
Identification identify_one(const Recording& recording, const Readings& readings, Recording rows,
                            const IdentificationSettings& settings) {
  Identification found = identify_long(rows, settings).identification;
  for (int time = 0; time < kReadingsAgain; ++time) {
    const bool swings = std::any_of(found.channels.begin(), found.channels.end(),
                                    [](const ChannelAnswer& answer) { return answer.pair; });
    if (found.model.channels.empty() || swings) break;
    const ModelSpec model = model_at(found, recording.sample_time_s);
    Recording again = of_readings(model, recording, readings);
    const Eigen::ArrayXd moved = (again.cvs - rows.cvs).col(0).array();
    const double rms = std::sqrt(moved.isFinite().select(moved, 0.0).square().mean());
    rows = std::move(again);
    if (rms < kReadingsPutRight * found.cvs.front().innovation_sd) break;
    found = identify_long(rows, settings).identification;
  }
  return found;
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
      const Recording one = of_cvs(recording, {cv});
      Recording rows = averaged(one, readings.every, readings.offsets);
      if (rows.samples() < needed_rows(rows.inputs.cols())) continue;
      const Readings its{readings.every, readings.offsets, {0}};
      put_in(identify_one(one, its, std::move(rows), of_cv(settings, cv)), cv, whole);
    }
  }
}

}  // namespace mpm
