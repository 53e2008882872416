#include "sim/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mpm::sim {

std::vector<PlantStage> plant_stages(const ModelSpec& model, std::vector<ChannelChange> changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const ChannelChange& left, const ChannelChange& right) {
                     return left.from_s < right.from_s;
                   });
  std::vector<PlantStage> stages;
  stages.push_back({0.0, model, {}});
  for (const ChannelChange& change : changes) {
    if (change.from_s > stages.back().from_s)
      stages.push_back({change.from_s, stages.back().model, {}});
    stages.back().model = changed_model(stages.back().model, {change});
    stages.back().begun.push_back(change);
  }
  return stages;
}

Plant::Plant(const ModelSpec& model, std::vector<ChannelChange> changes)
    : output_(Eigen::VectorXd::Zero(model.cv_count)) {
  for (const PlantStage& stage : plant_stages(model, std::move(changes))) {
    const double onset = stage.from_s / model.sample_time_s;
    Stage next{static_cast<std::int64_t>(std::ceil(onset - 1e-9)),
               LinearModel(stage.model),
               {},
               Eigen::VectorXd::Zero(model.cv_count)};
    const auto integrating = next.model.integrating();
    for (const ChannelChange& change : stage.begun)
      if (integrating(change.cv, change.input)) next.carried_cvs.push_back(change.cv);
    stages_.push_back(std::move(next));
  }
  compute_output();
}

void Plant::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  for (Stage& stage : stages_) stage.model.advance(input);
  ++interval_;
  compute_output();
}

void Plant::compute_output() {
  while (current_ + 1 < stages_.size() && stages_[current_ + 1].first_interval <= interval_) {
    const Stage& before = stages_[current_];
    Stage& after = stages_[++current_];
    for (const int cv : after.carried_cvs)
      after.offset(cv) = before.model.output()(cv) + before.offset(cv) - after.model.output()(cv);
    for (Eigen::Index cv = 0; cv < before.offset.size(); ++cv)
      if (std::find(after.carried_cvs.begin(), after.carried_cvs.end(), cv) ==
          after.carried_cvs.end())
        after.offset(cv) = before.offset(cv);
  }
  output_ = stages_[current_].model.output() + stages_[current_].offset;
}

}  // namespace mpm::sim
