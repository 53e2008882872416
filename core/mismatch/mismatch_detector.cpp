#include "core/mismatch/mismatch_detector.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {

MismatchDetector::MismatchDetector(const RegressionShape& shape,
                                   const std::vector<MemoryLength>& memories, int remembered,
                                   int patience, const LinearModel& model,
                                   std::vector<MaterialityLimits> limits)
    : shape_(shape),
      memory_count_(static_cast<int>(memories.size())),
      model_(model),
      history_(shape, remembered),
      older_(shape, memories.empty() ? 1.0 : memories.front().lambda, remembered),
      forgetful_(shape.cvs),
      curvatures_(static_cast<std::size_t>(shape.cvs)),
      work_(shape.columns() + VolterraTerms::most_columns(), patience),
      evaluator_(shape, model, std::move(limits)),
      evidence_(static_cast<std::size_t>(shape.inputs * shape.cvs) * memories.size()),
      again_(static_cast<std::size_t>(shape.inputs)),
      explained_(static_cast<std::size_t>(shape.cvs)),
      doubted_(static_cast<std::size_t>(shape.cvs) * memories.size()),
      beside_(static_cast<std::size_t>(shape.cvs)) {
  for (int j = 0; j < shape.cvs; ++j) regressions_.emplace_back(shape, j, memories, remembered);
}

void MismatchDetector::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                              const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  history_.push(inputs, residuals);
  for (ResidualRegression& regression : regressions_) regression.add_sample(history_, work_);
  if (older_.outweighs(history_)) forgetful_ = 0;
  if (forgetful_ == shape_.cvs) return;
  if (regression(forgetful_).memory(0).rows > older_.depth()) forget_older(forgetful_);
  ++forgetful_;
}

// The CV's regression begins anew with the last `older_.depth()` samples, without a curvature that
// older ones may have shown. One CV a sample: each takes as long as thousands of samples do.
void MismatchDetector::forget_older(int cv) {
  ResidualRegression& regression = regressions_[static_cast<std::size_t>(cv)];
  regression.fold(history_, work_);
  std::optional<Curvature>& found = curvatures_[static_cast<std::size_t>(cv)];
  if (found) {
    found.reset();
    evaluator_.give_back_limits(cv);
    regression.leave_out_terms();
  }
  regression.start_afresh(older_.depth(), history_, work_);
}

void MismatchDetector::skip(std::int64_t missing) {
  for (ResidualRegression& regression : regressions_) regression.fold(history_, work_);
  history_.skip(missing);
  for (ResidualRegression& regression : regressions_) {
    regression.add_gap(missing);
    regression.follow_gap(missing, history_);
  }
}

void MismatchDetector::fold(int cv) {
  regressions_[static_cast<std::size_t>(cv)].fold(history_, work_);
}

void MismatchDetector::evaluate(int cv, int memory) {
  fold(cv);
  const std::span evidence(&evidence_[first_evidence(cv, memory)],
                           static_cast<std::size_t>(shape_.inputs));
  evaluator_.evaluate(cv, regression(cv).memory(memory), evidence.data());
  if (memory == 0) explained_[static_cast<std::size_t>(cv)] = evaluator_.explained();
  const auto doubted = std::span(doubted_).subspan(static_cast<std::size_t>(memory * shape_.cvs),
                                                   static_cast<std::size_t>(shape_.cvs));
  doubted[static_cast<std::size_t>(cv)] =
      std::ranges::any_of(evidence, [](const ChannelEvidence& channel) {
        return channel.p_value < calibration::coupled_errors::kDoubtedPValue;
      });
  if (std::ranges::none_of(doubted, std::identity())) return;
  for (int j = 0; j < shape_.cvs; ++j) {
    const RegressionMemory& other = regression(j).memory(memory);
    beside_[static_cast<std::size_t>(j)] = j == cv || other.ready() ? &other : nullptr;
  }
  evaluator_.evaluate_coupled(cv, beside_, doubted, evidence.data());
}

// Seldom asked: kept for each CV they would be larger than the rest of the evidence.
const Eigen::MatrixXd& MismatchDetector::usual_errors(int cv) {
  evaluator_.evaluate(cv, regression(cv).memory(0), again_.data());
  return evaluator_.usual_errors();
}

RivalSignal MismatchDetector::rival(int cv, const FollowedSignal& followed) const {
  if (followed.signal < 0) return {};
  const ChannelEvaluator::Explained& by = explained_[static_cast<std::size_t>(cv)];
  const double margin = calibration::confounding::kMargin * by.variance;
  // Without what so many coefficients explain by chance.
  const double inputs = by.inputs - by.variance * shape_.inputs * shape_.block();
  const bool much = followed.explained > calibration::confounding::kShare * inputs;
  const bool beside =
      by.variance > 0.0 &&
      f_upper_tail(followed.beside / (followed.numbers * by.variance), followed.numbers,
                   regression(cv).memory(0).freedom()) < calibration::confounding::kBesidePValue;
  return {followed.signal, much && followed.explained > by.usual_errors + margin,
          !much || (!beside && followed.explained < by.usual_errors - margin)};
}

bool MismatchDetector::unlike_errors(int cv) const {
  const ChannelEvaluator::Explained& by = explained_[static_cast<std::size_t>(cv)];
  // Without what so many coefficients explain by chance: chi-square, in variances of the noise.
  const double coefficients = shape_.inputs * shape_.block();
  const double inputs = by.inputs - by.variance * coefficients;
  const double usual_errors = by.usual_errors - by.variance * shape_.inputs * kUsualErrors;
  const double chance = by.variance * std::sqrt(2.0 * coefficients);
  return inputs > calibration::confounding::kBeyondChance * chance &&
         usual_errors < calibration::confounding::kUsualShare * inputs;
}

bool MismatchDetector::take_in_curvature(int cv, double least) {
  const auto at = static_cast<std::size_t>(cv);
  ResidualRegression& regression = regressions_[at];
  const int span = std::min(regression.span(), history_.settled());
  if (curvatures_[at] || span == 0) return false;
  fold(cv);
  VolterraTerms terms(model_, cv, history_, span);
  std::optional<Curvature> found = find_curvature(shape_, cv, history_, regression, terms);
  if (!found || !(found->p_value < calibration::curvature::kCertainPValue) ||
      !(found->explained > least))
    return false;
  for (int i = 0; i < shape_.inputs; ++i)
    evaluator_.widen_limits(cv, i,
                            calibration::curvature::kHarmlessShare *
                                found->channels[static_cast<std::size_t>(i)].gain_variation);
  curvatures_[at] = std::move(found);
  regression.take_in(std::move(terms), history_, work_);
  return true;
}

void MismatchDetector::archive(Archive& a) {
  // not archived: shape_, memory_count_, model_ (construction)
  // not archived: work_, beside_, again_ (empty between calls)
  a.within(forgetful_, 0, shape_.cvs);
  a(history_, older_, curvatures_, evaluator_, evidence_, explained_, doubted_);
  for (ResidualRegression& regression : regressions_)
    regression.archive(a, model_, history_, work_);
  for (const std::optional<Curvature>& found : curvatures_)
    a.require(!found || found->channels.size() == static_cast<std::size_t>(shape_.inputs),
              "a curvature of other inputs");
  for (const ChannelEvidence& evidence : evidence_)
    a.require(evidence.confounder >= -1 && evidence.confounder < shape_.inputs,
              "an input that is not there");
}

void MismatchDetector::start_afresh(int cv, int samples) {
  regressions_[static_cast<std::size_t>(cv)].start_afresh(samples, history_, work_);
}

}  // namespace mpm
