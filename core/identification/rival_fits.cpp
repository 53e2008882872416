#include "core/identification/rival_fits.hpp"

#include <cstddef>
#include <utility>

#include "core/identification/calibration.hpp"
#include "core/identification/start_values.hpp"
#include "core/identification/structure.hpp"

namespace mpm {

std::vector<RivalFit> rival_fits(const Material& material, const HighOrderModel& model,
                                 const std::vector<ChannelHint>& hints, int cv,
                                 const PredictionErrorFit& fit, const NoiseAssumption& noise,
                                 const std::vector<int>& inputs) {
  std::vector<RivalFit> rivals;
  if (inputs.empty()) return rivals;
  const StartSearch search(model, hints, material.all.sample_time_s);
  const double cost = search.cost(fit.channels);
  const auto fitted = [&](StartSearch::Start start) {
    return fit_prediction_error(material.all, cv, std::move(start.channels), noise, kMostSteps);
  };
  for (const int input : inputs) {
    rivals.push_back({fitted(search.beside(fit.channels, input)), input});
    for (std::size_t c = 0; c < fit.channels.size(); ++c) {
      std::vector<ChannelShape> rest = fit.channels;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(c));
      StartSearch::Start start = search.beside(rest, input);
      if (start.cost > cost + kWorthFitting) continue;
      PredictionErrorFit instead = fitted(std::move(start));
      if (instead.cost < fit.cost + kAsGood)
        rivals.push_back({std::move(instead), input, fit.channels[c].input});
    }
  }
  return rivals;
}

}  // namespace mpm
