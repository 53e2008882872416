#include "tests/soak/plant.hpp"

#include <cmath>

namespace mpm::soak {
namespace {

constexpr double kRatio = 1.5;   // of a wrong gain to the model's
constexpr double kMoves = 0.05;  // of an input, chance per sample

}  // namespace

Plant::Plant(const config::UnitConfig& config, std::uint64_t seed, int right_samples,
             int wrong_samples)
    : config_(config),
      model_(config.model),
      right_samples_(right_samples),
      wrong_samples_(wrong_samples),
      left_(right_samples),
      moves_(Eigen::VectorXd::Zero(config.counts().inputs())),
      noise_(Eigen::VectorXd::Zero(config.counts().cv)),
      random_(seed),
      frame_(config.counts()) {
  for (const ChannelSpec& channel : config.model.channels)
    channels_.push_back(model_.channel(channel.cv, channel.input));
  for (SignalBlock& block : frame_.blocks)
    for (Quality& quality : block.quality) quality = Quality::kGood;
}

void Plant::change_over() {
  wrong_ = !wrong_;
  left_ = (wrong_ ? wrong_samples_ : right_samples_) - 1;
  const ChannelSpec& channel = config_.model.channels[channel_];
  const std::int64_t now_ns = frame_.source_time_ns;
  if (wrong_) {
    wrong_times_.push_back({config_.input_tag(channel.input),
                            config_.cv[static_cast<std::size_t>(channel.cv)].tag, now_ns, now_ns});
  } else {
    wrong_times_.back().until_ns = now_ns;
    channel_ = (channel_ + 1) % channels_.size();
  }
}

const Frame& Plant::next() {
  ++frame_.interval;
  frame_.source_time_ns = static_cast<std::int64_t>(1e9 * config_.sample_time_s) * ++samples_;
  if (left_-- == 0) change_over();
  std::normal_distribution<double> normal;
  const config::NoiseSettings& noise = config_.simulation.noise.front();
  SignalBlock& cv = frame_[SignalKind::kCv];
  cv.values = model_.output();
  if (wrong_)
    cv.values(config_.model.channels[channel_].cv) +=
        (kRatio - 1.0) * channels_[channel_].output()(0);
  for (Eigen::Index j = 0; j < noise_.size(); ++j) {
    noise_(j) = noise.pole * noise_(j) + noise.sigma * normal(random_);
    cv.values(j) += noise_(j);
  }
  for (Eigen::Index i = 0; i < moves_.size(); ++i)
    if (std::bernoulli_distribution(kMoves)(random_)) moves_(i) = 0.3 * normal(random_);
  frame_[SignalKind::kMv].values = moves_;
  model_.advance(moves_);
  for (std::size_t c = 0; c < channels_.size(); ++c)
    channels_[c].advance(moves_.segment(config_.model.channels[c].input, 1));
  return frame_;
}

}  // namespace mpm::soak
