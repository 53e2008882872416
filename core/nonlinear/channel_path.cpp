#include "core/nonlinear/channel_path.hpp"

#include "core/archive/archive.hpp"

namespace mpm {

ChannelPath::ChannelPath(const LinearModel& model, int cv, int input, double pole)
    : pole_(pole), value_(Eigen::VectorXd::Zero(1)) {
  const bool settles = !model.integrating()(cv, input);
  if (settles && model.steady_gain()(cv, input) != 0.0) channel_ = model.channel(cv, input);
}

void ChannelPath::rest(double value) {
  mean_ = value;
  value_(0) = value;
  if (channel_) channel_->reset_steady(value_);
}

void ChannelPath::archive(Archive& a) {
  // not archived: pole_ (construction)
  // not archived: value_ (empty between calls)
  a(mean_);
  if (channel_) a(*channel_);  // construction says whether there is one
}

void ChannelPath::advance(double value) {
  mean_ = pole_ * mean_ + (1.0 - pole_) * value;
  value_(0) = value;
  if (channel_) channel_->advance(value_);
}

}  // namespace mpm
