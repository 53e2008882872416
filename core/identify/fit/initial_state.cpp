#include "core/identify/fit/initial_state.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<double> decay_times(const ModelSpec& model, int cv) {
  std::vector<double> all;
  const auto add = [&](double time_constant_s) {
    all.push_back(time_constant_s / model.sample_time_s);
  };
  for (const ChannelSpec& channel : model.channels) {
    if (channel.cv != cv) continue;
    if (const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics))
      std::for_each(transfer->time_constants_s.begin(), transfer->time_constants_s.end(), add);
    else if (const auto* tanks = std::get_if<TankChain>(&channel.dynamics))
      std::for_each(tanks->time_constants_s.begin(), tanks->time_constants_s.end(), add);
    else
      add(slowest_time_constant_s(channel, model.sample_time_s));
  }
  std::sort(all.begin(), all.end());
  std::vector<double> picked;
  if (all.empty()) return picked;
  for (const std::size_t place : {std::size_t{0}, all.size() / 2, all.size() - 1})
    if (picked.empty() || all[place] > kOtherDecay * picked.back()) picked.push_back(all[place]);
  return picked;
}

double first_error(const Eigen::Ref<const VectorXd>& simulated,
                   const Eigen::Ref<const VectorXd>& measured) {
  double sum = 0.0;
  int count = 0;
  for (Index k = 0; k < measured.size() && count < kFirstRows; ++k) {
    const double error = measured(k) - simulated(k);
    if (std::isfinite(error)) sum += error * error, ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

double mean_error(const Eigen::Ref<const VectorXd>& simulated,
                  const Eigen::Ref<const VectorXd>& measured) {
  double sum = 0.0, count = 0.0;
  for (Index k = 0; k < measured.size(); ++k) {
    const double error = measured(k) - simulated(k);
    if (std::isfinite(error)) sum += error, ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

VectorXd start_on_data(const Eigen::Ref<const VectorXd>& simulated,
                       const Eigen::Ref<const VectorXd>& measured,
                       const std::vector<double>& decay_times) {
  const double scale = first_error(simulated, measured);
  const auto decays = static_cast<Index>(decay_times.size());
  const Index rows = std::min(
      measured.size() / kDecayQuarter,
      std::max<Index>(kDecayRows, decays > 0 ? static_cast<Index>(decay_times.back()) : 0));
  if (!(scale > 0.0) || decays == 0 || rows < kFirstRows) return simulated;
  const auto decay = [&](Index k, Index i) {
    return std::exp(-static_cast<double>(k) / decay_times[static_cast<std::size_t>(i)]);
  };
  // Ridge: before the data are seen, each is of the size of the first errors; what else they hold
  // is as large.
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(rows + decays, decays);
  VectorXd right = VectorXd::Zero(rows + decays);
  for (Index k = 0; k < rows; ++k) {
    const double error = measured(k) - simulated(k);
    if (!std::isfinite(error)) continue;
    for (Index i = 0; i < decays; ++i) system(k, i) = decay(k, i);
    right(k) = error;
  }
  system.bottomRows(decays).setIdentity();
  const VectorXd sizes = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(system).solve(right);
  VectorXd result = simulated;
  for (Index k = 0; k < result.size(); ++k)
    for (Index i = 0; i < decays; ++i) result(k) += sizes(i) * decay(k, i);
  return result;
}

}  // namespace mpm
