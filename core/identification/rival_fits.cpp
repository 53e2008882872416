#include "core/identification/rival_fits.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/start_values.hpp"
#include "core/identification/structure.hpp"

namespace mpm {
namespace {

/// Whether another input beside the channels is mixed up with any: one that is not tells nothing.
bool moves_gains(const std::vector<ChannelShape>& alone, const std::vector<ChannelShape>& beside) {
  for (std::size_t c = 0; c < alone.size(); ++c)
    if (std::abs(beside[c].gain - alone[c].gain) > kMovesGain * std::abs(alone[c].gain))
      return true;
  return false;
}

}  // namespace

std::vector<RivalFit> rival_fits(const Material& material, const HighOrderModel& model,
                                 const std::vector<ChannelHint>& hints, int cv,
                                 const PredictionErrorFit& fit, const NoiseAssumption& noise,
                                 const std::vector<int>& inputs) {
  std::vector<RivalFit> rivals;
  if (inputs.empty() || fit.channels.empty()) return rivals;
  const StartSearch search(model, hints, material.all.sample_time_s);
  const StartSearch::Start alone = search.alone(fit.channels);
  const auto fitted = [&](StartSearch::Start start) {
    return fit_prediction_error(material.all, cv, std::move(start.channels), noise, kMostSteps);
  };
  for (const int input : inputs) {
    StartSearch::Start beside = search.beside(fit.channels, input);
    if (moves_gains(alone.channels, beside.channels))
      rivals.push_back({fitted(std::move(beside)), input});
    for (std::size_t c = 0; c < fit.channels.size(); ++c) {
      std::vector<ChannelShape> rest = fit.channels;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(c));
      StartSearch::Start start = search.beside(rest, input);
      if (start.cost > alone.cost + kWorthFitting) continue;
      PredictionErrorFit instead = fitted(std::move(start));
      if (instead.cost < fit.cost + kAsGood)
        rivals.push_back({std::move(instead), input, fit.channels[c].input});
    }
  }
  return rivals;
}

}  // namespace mpm
