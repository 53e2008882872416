#include "sim/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/signals/intervals.hpp"

namespace mpm::sim {

std::vector<PlantStage> plant_stages(const ModelSpec& model, std::vector<ChannelChange> changes) {
  std::stable_sort(changes.begin(), changes.end(),
                   [](const ChannelChange& left, const ChannelChange& right) {
                     return left.from_s < right.from_s;
                   });
  std::vector<double> times = {0.0};
  for (const ChannelChange& change : changes) {
    if (change.until_s <= change.from_s) continue;
    times.push_back(change.from_s);
    if (std::isfinite(change.until_s)) times.push_back(change.until_s);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<PlantStage> stages;
  for (const double time_s : times) {
    std::vector<ChannelChange> in_force, altered;
    for (const ChannelChange& change : changes) {
      if (change.from_s <= time_s && time_s < change.until_s) in_force.push_back(change);
      if (change.from_s == time_s || change.until_s == time_s) altered.push_back(change);
    }
    stages.push_back({time_s, changed_model(model, in_force), std::move(altered)});
  }
  return stages;
}

Plant::Plant(const ModelSpec& model, std::vector<ChannelChange> changes)
    : output_(Eigen::VectorXd::Zero(model.cv_count)) {
  for (const PlantStage& stage : plant_stages(model, std::move(changes))) {
    Stage next{interval_at(stage.from_s, model.sample_time_s),
               LinearModel(stage.model),
               {},
               Eigen::VectorXd::Zero(model.cv_count)};
    const auto integrating = next.model.integrating();
    for (const ChannelChange& change : stage.altered)
      if (integrating(change.cv, change.input)) next.carried_cvs.push_back(change.cv);
    stages_.push_back(std::move(next));
  }
  compute_output();
}

void Plant::set_time_s(double time_s) {
  for (Stage& stage : stages_) stage.model.set_time_s(time_s);
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
