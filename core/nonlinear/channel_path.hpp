#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/model/linear_model.hpp"

namespace mpm {

class Archive;

/// The way from an input to a CV as the model has it, for what is not the input itself but a
/// function of it. Where the model has no such channel, or one that integrates (and would never
/// forget), an exponentially weighted mean stands for it. No allocation after construction.
class ChannelPath {
 public:
  /// `pole` in (0, 1), of the mean.
  ChannelPath(const LinearModel& model, int cv, int input, double pole);

  /// As if `value` had been there for ever.
  void rest(double value);
  /// At sample k, from the values up to k - 1.
  [[nodiscard]] double output() const { return channel_ ? channel_->output()(0) : mean_; }
  /// Takes the value of sample k.
  void advance(double value);

  void archive(Archive& a);

 private:
  std::optional<LinearModel> channel_;
  double pole_;
  double mean_ = 0.0;
  Eigen::VectorXd value_;
};

}  // namespace mpm
