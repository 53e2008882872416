#pragma once

#include <Eigen/Core>
#include <string>
#include <unordered_map>

#include "core/identify/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Free-running simulation of many similar models on one recording. A CV is the sum of its
/// channels, and what a channel gave is remembered: the next model that holds the same channel gets
/// it for nothing. Inputs are the model's, then the recording's aux signals.
class Simulator {
 public:
  /// `recording` must outlive the simulator. `origin` of the aux inputs is their mean.
  explicit Simulator(const Recording& recording);

  /// One CV of `model` (channels only, no state space) on all samples, in CV units, from rest at
  /// the first inputs.
  [[nodiscard]] Eigen::VectorXd cv(const ModelSpec& model, int cv);
  /// All CVs, samples x CVs.
  [[nodiscard]] Eigen::MatrixXd all(const ModelSpec& model);

  [[nodiscard]] const Recording& recording() const { return *recording_; }

 private:
  const Eigen::VectorXd& channel(const ModelSpec& model, const ChannelSpec& spec);
  [[nodiscard]] Eigen::VectorXd simulate(const ModelSpec& model, const ChannelSpec& spec) const;

  const Recording* recording_;
  std::unordered_map<std::string, Eigen::VectorXd> remembered_;
  std::size_t capacity_;
};

/// `model` with the recording's aux signals as further inputs that no channel uses yet.
[[nodiscard]] ModelSpec with_aux_inputs(const ModelSpec& model, const Recording& recording);

}  // namespace mpm
