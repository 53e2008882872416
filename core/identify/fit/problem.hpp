#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/effect.hpp"
#include "core/identify/fit/plateau.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/identify/fit/simulator.hpp"
#include "core/identify/fit/whitening.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Small errors that every model has: fitted beside any effect, under a Gaussian prior.
struct Tolerances {
  double gain = 0.02;               ///< s.d. of the relative gain error
  double log_time_constant = 0.03;  ///< s.d. of the log of the time constants' ratio
  double dead_time_samples = 0.1;   ///< s.d.
};

/// A small error of one channel that is fitted beside any effect.
struct SmallError {
  int input = -1;  ///< -1: level or initial state of a run, or what goes before in others' noise
  const Quantity* quantity = nullptr;  ///< of the effect that would make it a large one
  double sd = 0.0;                     ///< of the tolerance, in the form of that quantity
};

/// What one CV's fit works on, whatever is fitted: A(q) (y - ysim - nuisances beta) is white.
struct CvData {
  Eigen::VectorXd measured;  ///< 0 where unknown
  Eigen::VectorXd known;     ///< 1 or 0
  Eigen::VectorXd weights;   ///< of each row of the whitened residual; 0 = not to be used
  /// Scaled so that beta ~ N(0, I) before the data are seen. The first are the levels of the runs.
  Eigen::MatrixXd nuisances;
  std::vector<SmallError> meaning;  ///< of each nuisance
  std::vector<Run> runs;
  double rows = 0.0;         ///< with a weight
  double measured_sd = 0.0;  ///< of all that was measured, clipped or not
};

/// One CV's side of a fit.
struct CvFit {
  int cv = 0;
  Whitening noise;
  Eigen::VectorXd beta;         ///< of the nuisances
  Eigen::VectorXd residual;     ///< y - ysim - nuisances beta; 0 where unknown
  Eigen::VectorXd innovations;  ///< whitened residual
  double variance = 1.0;        ///< of the innovations, weighted
};

/// How far the CV is off by itself, CV units: the mean over its known rows of the levels that a fit
/// gave its runs.
[[nodiscard]] double mean_level(const CvData& data, const CvFit& fit);

/// What the effects of a fit leave of a CV about the levels of its runs, NaN where unknown: the
/// residual before first states and the channels' small errors, which shift its level and are
/// enough to follow a walk.
[[nodiscard]] Eigen::VectorXd left_of(const CvData& data, const CvFit& fit);

/// Signals as the rows of a fit's least squares: whitened and weighted, in s.d. of the innovations;
/// 0 where the CV is unknown. Both must outlive it.
class WhitenedRows {
 public:
  WhitenedRows(const CvData& data, const CvFit& fit);
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::Ref<const Eigen::VectorXd>& x) const;

 private:
  const Eigen::VectorXd* known_;
  const Whitening* noise_;
  Eigen::VectorXd root_;  // of the weights, per s.d.
};

/// Effects with fitted numbers, and how well they explain the CVs they touch.
struct Fit {
  std::vector<Effect> effects;
  std::vector<CvFit> cvs;
  /// -2 ln of the marginal likelihood (Laplace): sum n ln variance + penalties + ln det of what the
  /// data add to the prior's information. Comparable between fits of the same CVs only.
  double cost = 0.0;
  double misfit = 0.0;  ///< sum n ln variance
  /// The part of `cost` that is no misfit: penalties and ln det.
  double complexity = 0.0;
  /// Of the free coordinates in order; posterior.
  Eigen::MatrixXd covariance;
};

/// The data, the model and its tolerances, ready for any number of fits, by any number of threads
/// at once: only settle() changes it.
///
/// A fit is generalised least squares (Gauss-Newton, finite differences, orthogonal) of the
/// effects' coordinates, each CV with its own autoregressive noise, re-estimated in every step.
/// Each CV is reduced to its square-root information on the shared coordinates, so that an effect
/// in an input may be seen by all CVs at once (Bierman 1977).
class Problem {
 public:
  /// `model` in channels and with aux inputs; `recording` must outlive the problem.
  Problem(const ModelSpec& model, int model_inputs, const Recording& recording,
          const Tolerances& tolerances, const NoiseModel& noise);

  /// Makes the tolerances those of the model with `effects`, and the rows' weights those that
  /// `fit`'s innovations ask for: heavy tails and loud stretches count less.
  void settle(const std::vector<Effect>& effects, const Fit* fit);
  /// As it is settled, to come back to: a fit can be read with the nuisances alone that it had.
  [[nodiscard]] const std::vector<CvData>& settled() const { return data_; }
  void settle(std::vector<CvData> settled) { data_ = std::move(settled); }

  /// Fits the coordinates of `effects` from `first_free` on; the ones before stay as they are.
  [[nodiscard]] Fit fit(std::vector<Effect> effects, std::size_t first_free,
                        const std::vector<int>& cvs, int iterations = 8);

  /// What the CVs of `fit` would cost with `effects` as they stand and the noise models of `fit`,
  /// on the scale on which `fit` itself costs `rows + complexity`.
  [[nodiscard]] double cost_with_noise_of(const Fit& fit, const std::vector<Effect>& effects);

  /// The row in first .. last from which on the last effect of `fit` best acts, all else held.
  [[nodiscard]] Eigen::Index best_onset(const Fit& fit, Eigen::Index first, Eigen::Index last);

  /// CV with the effects, each from its onset on.
  [[nodiscard]] Eigen::VectorXd simulate(const std::vector<Effect>& effects, int cv);
  /// d simulate / d coordinate times the coordinate's prior s.d.
  [[nodiscard]] Eigen::VectorXd sensitivity(const std::vector<Effect>& effects, std::size_t effect,
                                            std::size_t coordinate, int cv,
                                            const Eigen::VectorXd& at);

  /// The levels that a CV does not read beyond, as the data show; rows there count as unknown.
  [[nodiscard]] const Plateaus& plateaus(int cv) const {
    return plateaus_[static_cast<std::size_t>(cv)];
  }
  [[nodiscard]] const ModelSpec& model() const { return model_; }
  [[nodiscard]] const Surroundings& surroundings() const { return surroundings_; }
  [[nodiscard]] const Recording& recording() const { return simulator_.recording(); }
  [[nodiscard]] const CvData& data(int cv) const { return data_[static_cast<std::size_t>(cv)]; }
  [[nodiscard]] const NoiseModel& noise() const { return noise_; }
  [[nodiscard]] Eigen::Index samples() const { return recording().samples(); }

 private:
  class Fitting;  // one call of fit(), in fitting.cpp
  [[nodiscard]] ModelSpec with(const std::vector<Effect>& effects) const;
  /// Where a CV is clipped, and its rows as unknown.
  [[nodiscard]] Plateaus take_out_plateaus(int cv, CvData& data) const;
  /// Innovations as they would be without the jumps in `effects`, at their onsets: a shock in the
  /// noise looks like a jump there, and must not lose what makes it one by being fitted.
  [[nodiscard]] Eigen::VectorXd with_shocks(const CvFit& state, const std::vector<Effect>& effects);
  /// Small errors about `model`, the one with `effects`.
  void make_nuisances(const ModelSpec& model, const std::vector<Effect>& effects, int cv);
  /// The nuisances that no effect makes superfluous; the others are zero.
  [[nodiscard]] Eigen::MatrixXd nuisances(const std::vector<Effect>& effects, int cv) const;
  void update(CvFit& state, const Eigen::VectorXd& simulated,
              const Eigen::MatrixXd& nuisances) const;

  ModelSpec model_;
  Surroundings surroundings_;
  Simulator simulator_;
  Tolerances tolerances_;
  NoiseModel noise_;
  std::vector<CvData> data_;
  std::vector<Plateaus> plateaus_;
};

/// The CVs that an effect touches, ascending.
[[nodiscard]] std::vector<int> touched(const Effect& effect, const Problem& problem);

}  // namespace mpm
