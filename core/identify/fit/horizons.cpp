#include "core/identify/fit/horizons.hpp"

#include <algorithm>
#include <cmath>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<Index> horizons_of(const ModelSpec& model, Index longest) {
  double settling = 1.0;
  for (const ChannelSpec& channel : model.channels) {
    const double lag = slowest_time_constant_s(channel, model.sample_time_s);
    const double dead = removable_dead_time_s(channel, model.sample_time_s);
    settling = std::max(settling, (kSettlingTimeConstants * lag + dead) / model.sample_time_s);
  }
  std::vector<Index> found;
  for (const double share : {0.0, 0.5, 1.0, 2.0}) {
    const double wanted = std::min(share * settling, static_cast<double>(longest));
    const Index horizon = std::max<Index>(1, static_cast<Index>(std::lround(wanted)));
    if (found.empty() || horizon > found.back()) found.push_back(horizon);
  }
  return found;
}

VectorXd squared_prediction_errors(const Eigen::Ref<const VectorXd>& residual, Index horizon) {
  const Index rows = std::max<Index>(0, residual.size() - horizon);
  return (residual.tail(rows) - residual.head(rows)).cwiseAbs2();
}

}  // namespace mpm
