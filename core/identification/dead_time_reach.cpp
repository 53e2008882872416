#include "core/identification/dead_time_reach.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/identification/calibration.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

using Eigen::Index;

/// Of -2 ln likelihood at the end of a 95 % interval: chi-square, one degree of freedom.
constexpr double kRise = kNormalTwoSided95 * kNormalTwoSided95;

/// How far the dead time of a channel may be away before the misfit says so, samples; of ever more
/// s.d. on either side, until two in a row are too far.
double reach_of(const IdentificationData& data, int cv, const NoiseAssumption& noise,
                const PredictionErrorFit& fit, std::size_t channel, double sd) {
  double reach = 0.0;
  for (const double side : {-1.0, 1.0}) {
    double within = 0.0, rise_within = 0.0;
    int too_far = 0;
    for (const double steps : kReachesOfDeadTime) {
      std::vector<ChannelShape> channels = fit.channels;
      ChannelShape& held = channels[channel];
      const double now = held.dead_time;
      const double wanted = now + side * steps * sd;
      held.dead_time = std::clamp(wanted, 0.0, static_cast<double>(data.samples()));
      held.dead_time_known = true;
      const bool is_last = held.dead_time != wanted;
      const double away = std::abs(held.dead_time - now);
      const double rise =
          fit_prediction_error(data, cv, std::move(channels), noise, kHeldSteps).cost - fit.cost;
      if (rise < kRise) {
        reach = std::max(reach, away);
        within = away;
        rise_within = rise;
        too_far = 0;
      } else if (too_far == 0) {
        const double share = (kRise - rise_within) / (rise - rise_within);
        reach = std::max(reach, within + share * (away - within));
        ++too_far;
      } else {
        break;
      }
      if (is_last) break;
    }
  }
  return reach;
}

}  // namespace

void widen_dead_times(const IdentificationData& data, int cv, const NoiseAssumption& noise,
                      PredictionErrorFit& fit) {
  Index number = 0;
  for (std::size_t c = 0; c < fit.channels.size(); ++c)
    for (const ShapeNumber which : free_numbers(fit.channels[c])) {
      const double sd = std::sqrt(fit.covariance(number, number));
      if (which == ShapeNumber::kDeadTime && sd > 0.0) {
        const double reach = reach_of(data, cv, noise, fit, c, sd);
        const double wider = std::max(1.0, reach / (kNormalTwoSided95 * sd));
        fit.covariance.row(number) *= wider;
        fit.covariance.col(number) *= wider;
      }
      ++number;
    }
}

}  // namespace mpm
