#include "core/mismatch/mismatch_detector.hpp"

#include <utility>

#include "core/mismatch/calibration.hpp"

namespace mpm {

MismatchDetector::MismatchDetector(const RegressionShape& shape,
                                   const std::vector<MemoryLength>& memories, int remembered,
                                   int patience, const LinearModel& model,
                                   std::vector<MaterialityLimits> limits)
    : shape_(shape),
      memory_count_(static_cast<int>(memories.size())),
      history_(shape, remembered),
      work_(shape.columns(), patience),
      evaluator_(shape, model, std::move(limits)),
      evidence_(static_cast<std::size_t>(shape.inputs * shape.cvs) * memories.size()),
      explained_(static_cast<std::size_t>(shape.cvs)) {
  for (int j = 0; j < shape.cvs; ++j) regressions_.emplace_back(shape, j, memories, remembered);
}

void MismatchDetector::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                              const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  history_.push(inputs, residuals);
  for (ResidualRegression& regression : regressions_) regression.add_sample(history_, work_);
}

void MismatchDetector::skip(std::int64_t missing) {
  for (ResidualRegression& regression : regressions_) regression.fold(history_, work_);
  history_.skip(missing);
  for (ResidualRegression& regression : regressions_) regression.add_gap(missing);
}

void MismatchDetector::fold(int cv) {
  regressions_[static_cast<std::size_t>(cv)].fold(history_, work_);
}

void MismatchDetector::evaluate(int cv, int memory) {
  fold(cv);
  evaluator_.evaluate(cv, regression(cv).memory(memory), &evidence_[first_evidence(cv, memory)]);
  if (memory == 0) explained_[static_cast<std::size_t>(cv)] = evaluator_.explained();
}

Rival MismatchDetector::rival(int cv, const FollowedSignal& followed) const {
  if (followed.signal < 0) return {};
  const ChannelEvaluator::Explained& by = explained_[static_cast<std::size_t>(cv)];
  const double margin = calibration::confounding::kMargin * by.variance;
  // Without what so many coefficients explain by chance.
  const double inputs = by.inputs - by.variance * shape_.inputs * shape_.block();
  const bool much = followed.explained > calibration::confounding::kShare * inputs;
  return {followed.signal, much && followed.explained > by.usual_errors + margin,
          !much || followed.explained < by.usual_errors - margin};
}

void MismatchDetector::start_afresh(int cv, int samples) {
  regressions_[static_cast<std::size_t>(cv)].start_afresh(samples, history_, work_);
}

}  // namespace mpm
