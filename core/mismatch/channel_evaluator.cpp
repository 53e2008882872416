#include "core/mismatch/channel_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/mismatch/slow_noise.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

// What the step response bears does not matter: usual errors of a size that it bears, and whatever
// errors that are allowed and what it bears explain. A model that was reduced from a plant of
// higher order is off in its first lags, which are seen sharply, and what lags and dead time make
// of that for later ones is hardly known. But a dead time alone is judged by its size (gain and
// time constant may be free to undo what it surely does), and so is what is hardly there.
template <class Beyond>
void bear(ChannelEvidence& evidence, std::optional<double> dead_time_alone, const Beyond& beyond) {
  const Estimate& step = evidence.step_error;
  if (evidence.usual &&
      std::min(step.value, dead_time_alone.value_or(step.value)) < evidence.step_limit)
    evidence.p_value_material = 1.0;
  const bool by_size = evidence.usual && dead_time_alone;
  if (!by_size && evidence.p_value_material < calibration::materiality::kAskedBelow)
    evidence.p_value_material = std::max(evidence.p_value_material, beyond());
  if (!evidence.usual) return;
  evidence.harmless =
      evidence.harmless || step.value + kNormalOneSided95 * step.deviation < evidence.step_limit;
}

}  // namespace

ChannelEvaluator::ChannelEvaluator(const RegressionShape& shape, const LinearModel& model,
                                   std::vector<MaterialityLimits> limits)
    : shape_(shape),
      signatures_(channel_signatures(shape, model)),
      limits_(std::move(limits)),
      estimates_(shape),
      covariance_(estimates_),
      excitation_(estimates_),
      usual_(shape.block()),
      joint_(shape),
      coupled_cvs_(shape),
      coupled_(shape),
      held_(shape),
      coupled_past_(Eigen::VectorXd::Zero(shape.past())),
      joint_usual_(kUsualErrors),
      materiality_(shape.block()),
      steps_(shape, model),
      sizes_(shape, model),
      estimate_(Eigen::VectorXd::Zero(shape.block())),
      directions_(Eigen::MatrixXd::Zero(shape.block(), error_column::kCount)),
      error_(Eigen::VectorXd::Zero(shape.block())),
      joint_error_(Eigen::VectorXd::Zero(kUsualErrors)) {
  if (limits_.size() == 1) limits_.resize(signatures_.size(), limits_.front());
  if (limits_.size() != signatures_.size())
    throw std::invalid_argument("materiality limits: one per channel, or one for all");
  given_limits_ = limits_;
}

void ChannelEvaluator::widen_limits(int cv, int input, double limit) {
  MaterialityLimits& limits = limits_[index(cv, input)];
  limits.gain = std::max(limits.gain, limit);
  limits.time_constant = std::max(limits.time_constant, limit);
  limits.gain_alone = true;
}

void ChannelEvaluator::give_back_limits(int cv) {
  for (int i = 0; i < shape_.inputs; ++i) limits_[index(cv, i)] = given_limits_[index(cv, i)];
}

void ChannelEvaluator::archive(Archive& a) {
  // not archived: shape_, signatures_, given_limits_ (construction)
  // not archived: explained_, estimates_, covariance_, excitation_, usual_, joint_, coupled_cvs_,
  // coupled_, held_, coupled_past_, joint_usual_, materiality_, steps_, sizes_, estimate_,
  // directions_, error_, joint_error_, slow_noise_ (each evaluation begins anew)
  a(limits_);
}

void ChannelEvaluator::evaluate(int cv, const RegressionMemory& memory, ChannelEvidence* evidence) {
  estimates_.read(cv, memory.factor);
  EstimateNoise noise = estimate_noise(memory);
  if (noise.variance == 0.0) {  // a simulation without any: known as far as its numbers go
    noise.variance = std::pow(rounding_of(cv), 2) / memory.weight_sum;
    noise.block_variance = noise.variance;
  }
  const double own = 1.0 - estimates_.own_past().sum();
  slow_noise_ =
      integrates(cv) ? 1.0 : slow_noise_ratio(own, slow_columns(own), memory.effective_rows());
  joint_.read(cv, memory.factor, signatures_, noise, estimates_);
  const double all = estimates_.rotated().squaredNorm();
  explained_ = {all, all - joint_.left_square(), noise.variance};
  for (int i = 0; i < shape_.inputs; ++i) {
    evidence[i] = ChannelEvidence{};
    if (estimates_.moved(i) && noise.variance > 0.0)
      judge(cv, i, noise, evidence[i]);
    else
      excitation_.clear(i, evidence[i]);
  }
  for (int i = 0; i < shape_.inputs; ++i)
    if (evidence[i].excitation_index >
        calibration::confounding::kMasked * evidence[i].excitation_index_alone)
      evidence[i].confounder = excitation_.confounder(i, estimates_);
}

// Of such a CV's wrong channels, too, the residual goes on by itself.
bool ChannelEvaluator::integrates(int cv) const {
  for (int i = 0; i < shape_.inputs; ++i)
    if (sizes_.integrates(cv, i)) return true;
  return false;
}

// The constant, what a wrong start leaves, and of each input that moves its level and its means, as
// far as they move more slowly than the noise.
double ChannelEvaluator::slow_columns(double own) const {
  const auto share = [own](double rows) { return rows / (rows + 1.0 / own); };
  double columns = 1.0 + static_cast<double>(shape_.start_poles.size());
  for (int i = 0; i < shape_.inputs && own > 0.0; ++i) {
    if (!estimates_.moved(i)) continue;
    const double rows = estimates_.memory(i);
    columns += share(rows);
    for (const double pole : shape_.tail_poles) columns += share(rows + 1.0 / (1.0 - pole));
  }
  return columns;
}

// Of what the model makes the inputs do, over all rows.
double ChannelEvaluator::rounding_of(int cv) const {
  double largest = 0.0;
  for (int i = 0; i < shape_.inputs; ++i)
    largest = std::max(largest, std::abs(signatures_[index(cv, i)].gain) * estimates_.norms(i)(0));
  return calibration::kRounding * largest;
}

void ChannelEvaluator::judge(int cv, int input, const EstimateNoise& noise,
                             ChannelEvidence& evidence) {
  const ChannelSignatures& channel = signatures_[index(cv, input)];
  covariance_.read(estimates_, input);
  estimate_ = estimates_.estimate(input);
  covariance_.whiten(estimate_);
  test_block(noise, evidence);

  evidence.reference_gain = reference_gain(cv, input);
  channel.errors.front().filter(estimates_.own_past().data(), error_);
  if (channel.gain == 0.0) error_ *= evidence.reference_gain;
  error_.array() *= estimates_.norms(input).array();
  excitation_.measure(input, error_, estimate_, estimates_, covariance_, noise, evidence);
  evidence.dead_time = sizes_.dead_time(cv, input);
  if (joint_.adequate())
    judge_jointly(cv, input, noise, evidence);
  else if (channel.gain != 0.0)  // of a channel that the model lacks no error is usual
    judge_alone(cv, input, noise, evidence);
  finish(cv, input, noise, evidence);
}

void ChannelEvaluator::finish(int cv, int input, const EstimateNoise& noise,
                              ChannelEvidence& evidence) const {
  const MaterialityLimits& limits = limits_[index(cv, input)];
  if (limits.gain_alone && !evidence.usual)
    evidence.p_value_material =
        std::max(evidence.p_value_material,
                 Materiality::beyond(evidence.gain_error, limits.gain, noise.freedom));
  // What matters was calibrated without; how well a number is known is said with it.
  evidence.gain_error.deviation *= slow_noise_;
  evidence.log_time_error.deviation *= slow_noise_;
}

void ChannelEvaluator::judge_alone(int cv, int input, const EstimateNoise& noise,
                                   ChannelEvidence& evidence) {
  const ChannelSignatures& channel = signatures_[index(cv, input)];
  usual_.clear();
  for (std::size_t e = 0; e < channel.errors.size(); ++e) {
    scaled_error(channel.errors[e], input, error_);
    covariance_.whiten(error_);
    if (e == error_column::kGain || e == error_column::kTime)
      directions_.col(static_cast<Eigen::Index>(e)) = error_;
    usual_.add(error_);
  }
  test_usual_errors(usual_, estimate_, noise, evidence);
  scaled_error(channel.shifts[0], input, directions_.col(error_column::kLater));
  scaled_error(channel.shifts[1], input, directions_.col(error_column::kEarlier));
  covariance_.whiten(directions_.col(error_column::kLater));
  covariance_.whiten(directions_.col(error_column::kEarlier));
  const MaterialityLimits& limits = limits_[index(cv, input)];
  const double left = materiality_.fit(estimate_, directions_, noise, evidence);
  materiality_.judge(left, estimate_, directions_, usual_, limits, noise, evidence);
  size_step(cv, input, noise, evidence);
  // What matters is judged of small errors, as it was calibrated; how large they are is said of
  // any.
  std::optional<double> dead_time_alone = evidence.step_error.value;
  if (evidence.p_value < calibration::error_sizes::kRefinedBelow)
    dead_time_alone = size_error(cv, input, left, noise, evidence);
  else if (!evidence.usual)
    estimate_free_gain(channel.gain, input, noise, evidence);
  bear(evidence, dead_time_alone, [&] {
    return steps_.beyond({cv, input, materiality_.beside_allowed(), usual_, noise}, estimates_,
                         covariance_, evidence.step_limit);
  });
}

void ChannelEvaluator::judge_jointly(int cv, int input, const EstimateNoise& noise,
                                     ChannelEvidence& evidence) {
  const InputErrors::Channel& channel = joint_.channel(input);
  read_usual(channel);
  test_usual_errors(joint_usual_, channel.estimate, noise, evidence);
  if (signatures_[index(cv, input)].gain == 0.0) return;
  size_among(
      cv, input, channel, [&] { return joint_.freed(input, estimates_); }, noise, evidence);
}

void ChannelEvaluator::read_usual(const InputErrors::Channel& channel) {
  joint_usual_.clear();
  for (int e = 0; e < kUsualErrors; ++e) {
    joint_error_ = channel.usual.col(e);
    joint_usual_.add(joint_error_);
  }
}

template <class FreeBlock>
void ChannelEvaluator::size_among(int cv, int input, const InputErrors::Channel& channel,
                                  const FreeBlock& free_block, const EstimateNoise& noise,
                                  ChannelEvidence& evidence) {
  const MaterialityLimits& limits = limits_[index(cv, input)];
  const double left = materiality_.fit(channel.estimate, channel.directions, noise, evidence);
  materiality_.judge(left, channel.estimate, channel.directions, joint_usual_, limits, noise,
                     evidence);
  size_step(cv, input, noise, evidence);
  std::optional<double> dead_time_alone = evidence.step_error.value;
  if (evidence.p_value < calibration::error_sizes::kRefinedBelow) {
    const auto freed = free_block();
    covariance_.read(freed.factor, freed.first);
    for (int r = 0; r < shape_.block(); ++r) estimate_(r) = freed.factor.z(freed.first + r, 0);
    dead_time_alone = size_error(cv, input, estimate_.squaredNorm(), noise, evidence);
  }
  bear(evidence, dead_time_alone, [&] {
    return steps_.beyond({cv, input, materiality_.beside_allowed().head(channel.estimate.size()),
                          joint_usual_, noise},
                         channel.usual, evidence.step_limit);
  });
}

void ChannelEvaluator::evaluate_coupled(int cv, std::span<const RegressionMemory* const> memories,
                                        std::span<const int> doubted, ChannelEvidence* evidence) {
  const RegressionMemory& own = *memories[static_cast<std::size_t>(cv)];
  const EstimateNoise noise = estimate_noise(own);
  const auto most = static_cast<std::size_t>(CoupledErrors::most_cvs(shape_));
  if (!(noise.variance > 0.0) || most < 2) return;
  std::span<const CoupledCvs::Other> others = coupled_cvs_.of(cv, memories);
  others = others.first(std::min(others.size(), most - 1));
  const auto doubt = [&](const CoupledCvs::Other& other) {
    return doubted[static_cast<std::size_t>(other.cv)] != 0;
  };
  if (std::ranges::none_of(others, doubt)) return;
  coupled_.clear();
  coupled_.add(cv, own.factor, noise);
  for (const CoupledCvs::Other& other : others) {
    const RegressionMemory& memory = *memories[static_cast<std::size_t>(other.cv)];
    coupled_.add(other.cv, memory.factor, estimate_noise(memory));
  }
  if (!coupled_.fit(signatures_, estimates_)) return;
  coupled_.own_past(coupled_past_);
  estimates_.set_own_past(coupled_past_);
  for (int i = 0; i < shape_.inputs; ++i)
    if (estimates_.moved(i)) judge_coupled(cv, i, noise, evidence[i]);
}

// What a channel's error explains by the curvature at the best fit may be explained nearly as well
// by other errors and other dynamics of the noise, far from there: by so much less is known.
double ChannelEvaluator::explained_otherwise(int input, const InputErrors::Channel& channel) {
  held_.fit_without(input, coupled_, estimates_);
  const double lost = held_.left_square() - coupled_.left_square();
  const double claimed = joint_usual_.explained(channel.estimate);
  const double least = calibration::rounding::kIndependentShare * claimed;
  return std::max(1.0, claimed / std::max(lost, least));
}

void ChannelEvaluator::judge_coupled(int cv, int input, const EstimateNoise& noise,
                                     ChannelEvidence& evidence) {
  const InputErrors::Channel& channel = coupled_.channel(input);
  const ChannelSignatures& signatures = signatures_[index(cv, input)];
  const double alone = evidence.p_value, material_alone = evidence.p_value_material;
  const auto test = [&](const EstimateNoise& with) {
    evidence.p_value = evidence.p_value_material = 1.0;
    evidence.statistic = evidence.numerator_freedom = 0.0;
    evidence.tests = 0;
    test_usual_errors(joint_usual_, channel.estimate, with, evidence);
  };
  read_usual(channel);
  test(noise);
  EstimateNoise known = noise;
  if (evidence.p_value < calibration::coupled_errors::kDoubtedPValue) {
    const double times = explained_otherwise(input, channel);
    known.variance *= times;
    known.block_variance *= times;
    test(known);
  }
  evidence.elsewhere = alone < calibration::coupled_errors::kDoubtedPValue &&
                       evidence.p_value > calibration::coupled_errors::kElsewherePValue;
  evidence.usual = evidence.harmless = false;
  joint_error_ = channel.usual.col(0);
  if (signatures.gain == 0.0) joint_error_ *= evidence.reference_gain;
  excitation_.measure_coupled(joint_error_, channel.estimate, known, evidence);
  if (signatures.gain == 0.0)
    evidence.p_value_material = evidence.p_value;
  else
    size_among(
        cv, input, channel, [&] { return coupled_.freed(input, estimates_); }, known, evidence);
  finish(cv, input, known, evidence);
  // What only other CVs' errors bring to light is no reason for an alarm beside theirs.
  evidence.p_value_material = std::max(evidence.p_value_material, material_alone);
}

void ChannelEvaluator::size_step(int cv, int input, const EstimateNoise& noise,
                                 ChannelEvidence& evidence) const {
  evidence.step_limit = limits_[index(cv, input)].step_response;
  const double undone = evidence.excitation_index / evidence.excitation_index_alone;
  if (std::isfinite(undone))
    evidence.step_limit =
        std::max(evidence.step_limit, calibration::materiality::kNoChannel *
                                          (undone - calibration::materiality::kUndone));
  evidence.step_error =
      steps_.of_fit(cv, input, materiality_.fitted(), materiality_.fitted_shift(), noise.variance);
}

void ChannelEvaluator::scaled_error(const Signature& error, int input,
                                    Eigen::Ref<Eigen::VectorXd> out) const {
  error.filter(estimates_.own_past().data(), out);
  out.array() *= estimates_.norms(input).array();
}

void ChannelEvaluator::test_block(const EstimateNoise& noise, ChannelEvidence& evidence) const {
  const int block = shape_.block();
  evidence.numerator_freedom = block;
  evidence.block_statistic = estimate_.squaredNorm() / (block * noise.block_variance);
  evidence.statistic = evidence.block_statistic;
  evidence.p_value = f_upper_tail(evidence.statistic, evidence.numerator_freedom, noise.freedom);
  evidence.p_value_material = evidence.p_value;
}

void ChannelEvaluator::test_usual_errors(const UsualErrorSpace& usual,
                                         const Eigen::VectorXd& estimate,
                                         const EstimateNoise& noise,
                                         ChannelEvidence& evidence) const {
  if (usual.rank() == 0) return;
  const auto test = [&](double explained, int freedom) {
    const double statistic = explained / (freedom * noise.variance);
    const double p_value = f_upper_tail(statistic, freedom, noise.freedom);
    ++evidence.tests;
    if (!(p_value < evidence.p_value)) return;
    evidence.p_value = p_value;
    evidence.statistic = statistic;
    evidence.numerator_freedom = freedom;
  };
  evidence.directed_statistic = usual.explained(estimate) / (usual.rank() * noise.variance);
  evidence.directed_freedom = usual.rank();
  test(usual.explained(estimate), usual.rank());
  if (usual.rank() > 1) test(usual.explained_by_first(estimate), 1);
  evidence.p_value = std::min(1.0, evidence.tests * evidence.p_value);
}

// With `covariance_` and `estimate_` of the input's block.
std::optional<double> ChannelEvaluator::size_error(int cv, int input, double left,
                                                   const EstimateNoise& noise,
                                                   ChannelEvidence& evidence) {
  const auto block = static_cast<double>(estimate_.size());
  const double enough = noise.variance * (block + 2.0 * std::sqrt(2.0 * block));  // two s.d.
  const ErrorSizes::Channel channel{cv,        input,          estimates_, covariance_,
                                    estimate_, noise.variance, steps_};
  const double refined = sizes_.refine(channel, left, enough, evidence);
  evidence.usual = Materiality::explained(refined, estimate_.size(), noise);
  if (!evidence.usual) {
    estimate_free_gain(signatures_[index(cv, input)].gain, input, noise, evidence);
    return std::nullopt;
  }
  constexpr double kOthers = 2.0;
  const ErrorSizes::DeadTimeAlone alone = sizes_.dead_time_alone(channel, evidence);
  const double more = std::max(0.0, alone.left - refined) / (kOthers * noise.variance);
  if (f_upper_tail(more, kOthers, noise.freedom) <= calibration::usual_errors::kUnusualPValue)
    return std::nullopt;
  return alone.step_error;
}

// The gain as the sum of the block's coefficients over A_j(1): free of the model's shape.
void ChannelEvaluator::estimate_free_gain(double model_gain, int input, const EstimateNoise& noise,
                                          ChannelEvidence& evidence) {
  const double own = 1.0 - estimates_.own_past().sum();
  if (!(own > 0.0)) return;           // the noise integrates: no gain can be read off
  error_ = estimates_.scales(input);  // weighs the sum of the unscaled coefficients
  const double sum = error_.dot(estimates_.estimate(input));
  const double variance = covariance_.variance_of(error_) * noise.variance;
  evidence.gain_error = {sum / own / model_gain, std::sqrt(variance) / own / std::abs(model_gain)};
}

// Of a channel that the model lacks, the smaller of two: what would move the CV as much as its
// strongest input has, and what the model's other channels make usual.
double ChannelEvaluator::reference_gain(int cv, int input) const {
  const ChannelSignatures& channel = signatures_[index(cv, input)];
  if (channel.gain != 0.0) return channel.gain;
  double largest = 0.0;
  for (int i = 0; i < shape_.inputs; ++i)
    largest = std::max(largest, std::abs(signatures_[index(cv, i)].gain) * estimates_.norms(i)(0));
  if (largest == 0.0) largest = estimates_.residual_norm();
  const double strongest = largest / estimates_.norms(input)(0);
  return channel.usual_gain > 0.0 ? std::min(strongest, channel.usual_gain) : strongest;
}

}  // namespace mpm
