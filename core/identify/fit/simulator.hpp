#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Free-running simulation of many similar models on one recording. A CV is the sum of its
/// channels, and what a channel gave is remembered: the next model that holds the same channel gets
/// it for nothing. Inputs are the model's, then the recording's aux signals.
class Simulator {
 public:
  /// `recording` must outlive the simulator. `origin` of the aux inputs is their mean.
  explicit Simulator(const Recording& recording);

  /// One CV of `model` (channels only, no state space) on all samples, in CV units, from rest: at
  /// the operating point or as if the first inputs had been there for ever, whichever is nearer to
  /// what was first measured. (The first row's inputs may be moves that nothing measured shows
  /// yet.)
  [[nodiscard]] Eigen::VectorXd cv(const ModelSpec& model, int cv);

  [[nodiscard]] const Recording& recording() const { return *recording_; }

 private:
  [[nodiscard]] Eigen::VectorXd sum_of_channels(const ModelSpec& model, int cv, bool from_origin);
  const Eigen::VectorXd& channel(const ModelSpec& model, const ChannelSpec& spec, bool from_origin);
  [[nodiscard]] Eigen::VectorXd simulate(const ModelSpec& model, const ChannelSpec& spec,
                                         bool from_origin) const;
  [[nodiscard]] bool starts_at_origin(const ModelSpec& model);

  const Recording* recording_;
  std::unordered_map<std::string, Eigen::VectorXd> remembered_;
  std::size_t capacity_;
  std::optional<bool> from_origin_;  ///< decided by the first model, kept for all others
};

/// `model` with the recording's aux signals as further inputs that no channel uses yet.
[[nodiscard]] ModelSpec with_aux_inputs(const ModelSpec& model, const Recording& recording);

}  // namespace mpm
