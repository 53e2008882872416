#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/model/linear_model.hpp"
#include "sim/plant/channel_change.hpp"
#include "sim/plant/process.hpp"

namespace mpm::sim {

/// The true process: the model with a scenario's changes, each from its time on.
///
/// One model per stage between onsets and ends; all run from the start on the same inputs, and the
/// output is that of the stage in force. So a change acts at once on what earlier inputs still do,
/// as a changed process gain or pipe would, and every state is right. A CV on which a changed
/// channel integrates keeps its level at the onset: only its further movement changes.
class Plant : public Process {
 public:
  Plant(const ModelSpec& model, std::vector<ChannelChange> changes);

  [[nodiscard]] int input_count() const override { return stages_.front().model.input_count(); }

  /// Time of the present output on the clock of the data; see `LinearModel::set_time_s`.
  void set_time_s(double time_s) override;

  /// y(k) without noise.
  [[nodiscard]] const Eigen::VectorXd& output() const override { return output_; }
  /// Takes u(k), MVs, DVs, and aux signals where its model has them.
  void advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  struct Stage {
    std::int64_t first_interval;
    LinearModel model;
    std::vector<int> carried_cvs;  ///< keep their level when this stage begins
    Eigen::VectorXd offset;
  };
  void compute_output();

  std::vector<Stage> stages_;
  std::size_t current_ = 0;
  std::int64_t interval_ = 0;
  Eigen::VectorXd output_;
};

/// The model in force from each onset or end of a change on, in order of time; the first entry is
/// the one at the start.
struct PlantStage {
  double from_s = 0.0;
  ModelSpec model;
  std::vector<ChannelChange> altered;  ///< changes that begin or end here
};
[[nodiscard]] std::vector<PlantStage> plant_stages(const ModelSpec& model,
                                                   std::vector<ChannelChange> changes);

}  // namespace mpm::sim
