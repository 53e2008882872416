#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"
#include "core/parallel/mutex.hpp"

namespace mpm {

/// Free-running simulation of many similar models on one recording. A CV is the sum of its channels
/// and disturbances, and what each gave is remembered: the next model that holds the same gets it
/// for nothing. Inputs are the model's, then the recording's aux signals. Any number of threads may
/// ask at once.
class Simulator {
 public:
  /// `recording` must outlive the simulator. `origin` of the aux inputs is their mean.
  explicit Simulator(const Recording& recording);

  /// One CV of `model` (channels only, no state space) on all samples, in CV units, each run from
  /// rest: at the operating point or as if its first inputs had been there for ever, whichever is
  /// nearer to what was first measured in it. (The first row's inputs may be moves that nothing
  /// measured shows yet.)
  [[nodiscard]] Eigen::VectorXd cv(const ModelSpec& model, int cv);

  [[nodiscard]] const Recording& recording() const { return *recording_; }

 private:
  /// Whether each run begins at the operating point.
  using Starts = std::vector<bool>;
  using Given = std::shared_ptr<const Eigen::VectorXd>;

  [[nodiscard]] Eigen::VectorXd sum_of_channels(const ModelSpec& model, int cv,
                                                const Starts& at_origin);
  Given channel(const ModelSpec& model, const ChannelSpec& spec, const Starts& at_origin);
  Given disturbance(const DisturbanceTerm& term, double sample_time_s);
  template <class Make>
  Given remembered(const std::string& key, const Make& make);
  [[nodiscard]] Eigen::VectorXd simulate(const ModelSpec& model, const ChannelSpec& spec,
                                         const Starts& at_origin) const;
  [[nodiscard]] const Starts& starts(const ModelSpec& model);
  [[nodiscard]] Starts first_starts(const ModelSpec& model);

  const Recording* recording_;
  std::vector<Run> runs_;
  std::once_flag begun_;
  Starts at_origin_;  ///< decided by the first model, kept for all others
  Mutex mutex_;
  std::unordered_map<std::string, Given> remembered_ MPM_GUARDED_BY(mutex_);
  std::size_t bytes_ MPM_GUARDED_BY(mutex_) = 0;  ///< that it takes
};

/// `model` with the recording's aux signals as further inputs that no channel uses yet.
[[nodiscard]] ModelSpec with_aux_inputs(const ModelSpec& model, const Recording& recording);

}  // namespace mpm
