#include "sim/signals/setpoints.hpp"

namespace mpm::sim {

RandomBinarySetpoints::RandomBinarySetpoints(const std::vector<config::SetpointSettings>& settings,
                                             const Eigen::VectorXd& origin, double amplitude_ratio,
                                             std::uint64_t seed)
    : origin_(origin), values_(origin) {
  const auto count = static_cast<std::int64_t>(settings.size());
  for (const config::SetpointSettings& each : settings) {
    const auto index = static_cast<std::int64_t>(channels_.size());
    channels_.push_back(
        {each.amplitude * amplitude_ratio, each.hold_samples, each.hold_samples * index / count,
         RandomStream(seed, StreamPurpose::kSetpoint, static_cast<std::uint64_t>(index))});
  }
}

const Eigen::VectorXd& RandomBinarySetpoints::next() {
  for (std::size_t j = 0; j < channels_.size(); ++j) {
    Channel& channel = channels_[j];
    if (interval_ != 0 && interval_ % channel.hold != channel.phase % channel.hold) continue;
    const double sign = channel.stream.uniform() < 0.5 ? -1.0 : 1.0;
    const auto cv = static_cast<Eigen::Index>(j);
    values_(cv) = origin_(cv) + sign * channel.amplitude;
  }
  ++interval_;
  return values_;
}

}  // namespace mpm::sim
