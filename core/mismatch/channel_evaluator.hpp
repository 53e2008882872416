#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/mismatch/block_covariance.hpp"
#include "core/mismatch/channel_evidence.hpp"
#include "core/mismatch/channel_signatures.hpp"
#include "core/mismatch/coupled_cvs.hpp"
#include "core/mismatch/coupled_errors.hpp"
#include "core/mismatch/error_reduction.hpp"
#include "core/mismatch/error_sizes.hpp"
#include "core/mismatch/estimate_noise.hpp"
#include "core/mismatch/gain_excitation.hpp"
#include "core/mismatch/input_estimates.hpp"
#include "core/mismatch/joint_errors.hpp"
#include "core/mismatch/materiality.hpp"
#include "core/mismatch/regression_memory.hpp"
#include "core/mismatch/step_errors.hpp"
#include "core/mismatch/usual_error_space.hpp"

namespace mpm {

class Archive;

/// Reads off a CV's factor what the data say about each of its channels.
///
/// Two tests are made and the smaller p counts, doubled: F over an input's whole block, which sees
/// any error, and F over the few directions in it that errors of gain, time constant and dead time
/// of the model's own channel would take (`usual_errors`), which sees those sooner. The other
/// inputs' blocks are free, so that no error of theirs leaks in; in the second test only as far as
/// usual errors go, where these explain all that is seen of any input (`JointErrors`). F's
/// denominator is that of `EstimateNoise`. Then the error is sized and held against its limits
/// (`Materiality`), and its s.d. says whether one would show (`GainExcitation`). No allocation
/// after construction.
class ChannelEvaluator {
 public:
  /// `model` says what a gain error of 100 % in a channel looks like. Where it has no channel,
  /// 100 % is a first-order lag with the slowest tail that moves the CV as much as its other
  /// inputs do (or, where it has none, as much as the residual moves). `limits`: one per channel,
  /// input-major, or one for all.
  ChannelEvaluator(const RegressionShape& shape, const LinearModel& model,
                   std::vector<MaterialityLimits> limits);

  /// An error of the gain or the time constant up to `limit` (relative) matters in this channel no
  /// longer, if it did, nor does what is no such error beside its gain.
  void widen_limits(int cv, int input, double limit);
  /// As they were given, of a CV's channels.
  void give_back_limits(int cv);
  /// Evidence of all inputs to one CV into `evidence` (as many as inputs); the memory is ready.
  void evaluate(int cv, const RegressionMemory& memory, ChannelEvidence* evidence);
  /// The same of the CV that was evaluated last, together with those whose residuals its own rests
  /// on, where a channel of one of these may be wrong: what that does to the others' noise is no
  /// error of the CV's own channels (`CoupledErrors`). `memories`: of all CVs, null of those that
  /// are not ready; `doubted`: whether a CV by itself has a channel that may be wrong.
  /// While no other has, what is seen is the CV's own.
  void evaluate_coupled(int cv, std::span<const RegressionMemory* const> memories,
                        std::span<const int> doubted, ChannelEvidence* evidence);
  /// What is explained of a CV's residual beyond its own past, in squares.
  struct Explained {
    double inputs = 0.0;        ///< by all inputs' blocks
    double usual_errors = 0.0;  ///< by usual errors of all channels alone
    double variance = 0.0;      ///< of the noise
    template <class Archive>
    void archive(Archive& a) {
      a(inputs, usual_errors, variance);
    }
  };
  /// Of the last `evaluate`.
  [[nodiscard]] const Explained& explained() const { return explained_; }
  /// Likewise: `JointErrors::errors` of all channels of the CV.
  [[nodiscard]] const Eigen::MatrixXd& usual_errors() const { return joint_.errors(); }

  void archive(Archive& a);

 private:
  [[nodiscard]] std::size_t index(int cv, int input) const {
    return static_cast<std::size_t>(input * shape_.cvs + cv);
  }
  void judge(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence);
  void test_block(const EstimateNoise& noise, ChannelEvidence& evidence) const;
  /// The usual errors with the other inputs' blocks free, and with their usual errors free.
  void judge_alone(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence);
  void judge_jointly(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence);
  void judge_coupled(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence);
  /// What a channel's error is said to explain over what the best fit without it loses, >= 1: so
  /// many times larger is the variance of what is known of it.
  [[nodiscard]] double explained_otherwise(int input, const InputErrors::Channel& channel);
  void read_usual(const InputErrors::Channel& channel);
  /// Of a channel whose usual errors have been tested; `free_block()` frees the input's own block.
  template <class FreeBlock>
  void size_among(int cv, int input, const InputErrors::Channel& channel,
                  const FreeBlock& free_block, const EstimateNoise& noise,
                  ChannelEvidence& evidence);
  void finish(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence) const;
  void test_usual_errors(const UsualErrorSpace& usual, const Eigen::VectorXd& estimate,
                         const EstimateNoise& noise, ChannelEvidence& evidence) const;
  /// How much of the step response the error is, by its linear sizes, and how much is borne.
  void size_step(int cv, int input, const EstimateNoise& noise, ChannelEvidence& evidence) const;
  /// Of the step response, the error that a dead time alone makes, if usual errors of all kinds
  /// explain no more of what is seen.
  std::optional<double> size_error(int cv, int input, double left, const EstimateNoise& noise,
                                   ChannelEvidence& evidence);
  void estimate_free_gain(double model_gain, int input, const EstimateNoise& noise,
                          ChannelEvidence& evidence);
  /// The error's coefficients on the input's block, scaled.
  void scaled_error(const Signature& error, int input, Eigen::Ref<Eigen::VectorXd> out) const;
  [[nodiscard]] double reference_gain(int cv, int input) const;
  [[nodiscard]] double rounding_of(int cv) const;
  [[nodiscard]] bool integrates(int cv) const;
  [[nodiscard]] double slow_columns(double own) const;

  Explained explained_;
  RegressionShape shape_;
  std::vector<ChannelSignatures> signatures_;  // input-major
  std::vector<MaterialityLimits> limits_;      // likewise
  std::vector<MaterialityLimits> given_limits_;

  InputEstimates estimates_;    // of the CV last evaluated
  BlockCovariance covariance_;  // of the input at hand
  GainExcitation excitation_;
  UsualErrorSpace usual_;
  JointErrors joint_;
  CoupledCvs coupled_cvs_;
  CoupledErrors coupled_, held_;
  Eigen::VectorXd coupled_past_;
  UsualErrorSpace joint_usual_;
  Materiality materiality_;
  StepErrors steps_;
  ErrorSizes sizes_;
  Eigen::VectorXd estimate_;    // of the input's coefficients, whitened
  Eigen::MatrixXd directions_;  // block x error_column::kCount, whitened
  Eigen::VectorXd error_;
  Eigen::VectorXd joint_error_;  // kUsualErrors
  double slow_noise_ = 1.0;      // by so much s.d. of gains and time constants are too small
};

}  // namespace mpm
