#include "sim/signals/setpoints.hpp"

namespace mpm::sim {

RandomBinarySetpoints::RandomBinarySetpoints(const std::vector<SetpointSource>& sources,
                                             const Eigen::VectorXd& origin, std::uint64_t seed)
    : origin_(origin), values_(origin) {
  const auto count = static_cast<std::int64_t>(sources.size());
  for (const SetpointSource& source : sources) {
    const std::int64_t hold = sources.at(source.leader).settings.hold_samples;
    channels_.push_back({source.settings.amplitude, hold,
                         hold * static_cast<std::int64_t>(source.leader) / count,
                         RandomStream(seed, StreamPurpose::kSetpoint, source.leader)});
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
