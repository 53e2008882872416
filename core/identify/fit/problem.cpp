#include "core/identify/fit/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/initial_state.hpp"
#include "core/identify/fit/noise_before.hpp"
#include "core/identify/fit/plateau.hpp"
#include "core/identify/fit/row_weights.hpp"
#include "core/identify/fit/triangle.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double spread(const VectorXd& values, const VectorXd& known) {
  const double count = std::max(1.0, known.sum());
  const double mean = values.dot(known) / count;
  return std::sqrt(
      std::max(kLeastVariance, ((values.array() - mean).square() * known.array()).sum() / count));
}

/// A small step away from a model that all but runs away may be one that does: of such a number the
/// data can tell nothing.
VectorXd or_nothing(VectorXd slope) {
  if (!slope.allFinite()) slope.setZero();
  return slope;
}

}  // namespace

double mean_level(const CvData& data, const CvFit& fit) {
  const double all = std::max(1.0, data.known.sum());
  double mean = 0.0;
  for (std::size_t r = 0; r < data.runs.size(); ++r) {
    const auto& [first, count] = data.runs[r];
    const auto column = static_cast<Index>(r);
    const double share = data.known.segment(first, count).sum() / all;
    mean += share * (data.nuisances(first, column) * fit.beta(column));
  }
  return mean;
}

VectorXd left_of(const CvData& data, const CvFit& fit) {
  const Index small = data.nuisances.cols() - static_cast<Index>(data.runs.size());
  const VectorXd left = fit.residual + data.nuisances.rightCols(small) * fit.beta.tail(small);
  return (data.known.array() > 0.0).select(left, std::numeric_limits<double>::quiet_NaN());
}

WhitenedRows::WhitenedRows(const CvData& data, const CvFit& fit)
    : known_(&data.known), noise_(&fit.noise), root_((data.weights / fit.variance).cwiseSqrt()) {}

VectorXd WhitenedRows::operator()(const Eigen::Ref<const VectorXd>& x) const {
  return noise_->apply(x.cwiseProduct(*known_)).cwiseProduct(root_);
}

Problem::Problem(const ModelSpec& model, int model_inputs, const Recording& recording,
                 const Tolerances& tolerances, const NoiseModel& noise)
    : model_(model),
      surroundings_{recording.sample_time_s, recording.start_s, model_inputs},
      simulator_(recording),
      tolerances_(tolerances),
      noise_(noise) {
  for (int cv = 0; cv < model.cv_count; ++cv) {
    CvData data;
    data.runs = runs_of(recording);
    const auto measured = recording.cvs.col(cv);
    data.known = measured.unaryExpr([](double y) { return std::isfinite(y) ? 1.0 : 0.0; });
    data.measured = measured.unaryExpr([](double y) { return std::isfinite(y) ? y : 0.0; });
    data.measured_sd = spread(data.measured, data.known);
    plateaus_.push_back(take_out_plateaus(cv, data));
    data_.push_back(std::move(data));
  }
  settle({}, nullptr);
}

Plateaus Problem::take_out_plateaus(int cv, CvData& data) const {
  if (model_.output_blocks[static_cast<std::size_t>(cv)]) return {};
  const auto measured = recording().cvs.col(cv);
  const Plateaus plateaus = find_plateaus(measured);
  for (Index k = 0; k < measured.size(); ++k)
    if (plateaus.hold(measured(k))) data.known(k) = data.measured(k) = 0.0;
  return plateaus;
}

ModelSpec Problem::with(const std::vector<Effect>& effects) const {
  ModelSpec model = model_;
  for (const Effect& effect : effects) apply(effect, surroundings_, model);
  return model;
}

void Problem::make_nuisances(const ModelSpec& model, const std::vector<Effect>& effects, int cv) {
  CvData& data = data_[static_cast<std::size_t>(cv)];
  const Index samples = data.measured.size();
  const double scale = spread(data.measured, data.known);
  std::vector<VectorXd> columns;
  data.meaning.clear();
  const auto add = [&](const SmallError& meaning, const VectorXd& column) {
    columns.push_back(column);
    data.meaning.push_back(meaning);
  };

  const VectorXd base = simulator_.cv(model, cv);
  const VectorXd misfit = (data.measured - base).cwiseProduct(data.known);
  // A level far beyond what the simulation is off by would make any noise look like a wandering
  // one, and a wandering one leaves the level free.
  for (const auto& [first, count] : data.runs) {
    const double known = std::max(1.0, data.known.segment(first, count).sum());
    const double off =
        std::max(kLeastLevel * scale, misfit.segment(first, count).norm() / std::sqrt(known));
    VectorXd level = VectorXd::Zero(samples);
    level.segment(first, count).setConstant(off);
    add({}, level);
  }
  // What is of one run stands before what is of all (`triangle`).
  // A first state that is off by more than it shows would explain whatever one wants.
  // Noise alone is off by a few times what it moves by in a row.
  double moved = 0.0;
  for (const auto& [first, count] : data.runs)
    moved +=
        (misfit.segment(first + 1, count - 1) - misfit.segment(first, count - 1)).squaredNorm();
  const double moves = std::sqrt(moved / static_cast<double>(samples));
  const std::vector<double> decays = decay_times(model, cv);
  for (const auto& [first, count] : data.runs) {
    const double size = std::max(
        {kLeastFirstState * scale,
         first_error(base.segment(first, count), recording().cvs.col(cv).segment(first, count)),
         kMovesOfNoise * moves});
    for (const double decay : decays) {
      VectorXd column = VectorXd::Zero(samples);
      for (Index k = 0; k < count; ++k)
        column(first + k) = size * std::exp(-static_cast<double>(k) / decay);
      add({}, column);
    }
  }
  // What a bounded noise is there to show, others' noise would swallow as well.
  if (noise_.bound == 0.0 && !recording().noise_before.empty())
    for (const int other : recording().noise_before[static_cast<std::size_t>(cv)]) {
      const CvData& theirs = this->data(other);
      const MatrixXd before =
          noise_before((theirs.measured - simulate(effects, other)).cwiseProduct(theirs.known),
                       theirs.known, data.runs, noise_);
      for (const auto& column : before.colwise())
        if (column.squaredNorm() > 0.0) add({}, misfit.norm() / column.norm() * column);
    }
  for (std::size_t c = 0; c < model.channels.size(); ++c) {
    const ChannelSpec& channel = model.channels[c];
    if (channel.cv != cv) continue;
    const auto difference = [&](const ChannelError& error, double step) -> VectorXd {
      ModelSpec changed = model;
      changed.channels[c] = edited(channel, error, model.sample_time_s);
      return or_nothing((simulator_.cv(changed, cv) - base) / step);
    };
    const auto small = [&](const Quantity& what, double sd, const VectorXd& derivative) {
      add({channel.input, &what, sd}, sd * derivative);
    };
    small(kGainRatio, tolerances_.gain,
          difference({1.0 + kSmallRatioStep, 1.0, 0.0}, kSmallRatioStep));
    small(kTimeConstantRatio, tolerances_.log_time_constant,
          difference({1.0, std::exp(kSmallRatioStep), 0.0}, kSmallRatioStep));
    if (std::holds_alternative<TransferFunction>(channel.dynamics))
      small(kDeadTimeError, tolerances_.dead_time_samples,
            difference({1.0, 1.0, kSmallDeadTimeStep * model.sample_time_s}, kSmallDeadTimeStep));
  }
  data.nuisances.resize(samples, static_cast<Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    data.nuisances.col(static_cast<Index>(i)) = columns[i];
}

VectorXd Problem::with_shocks(const CvFit& state, const std::vector<Effect>& effects) {
  VectorXd innovations = state.innovations;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Effect& effect = effects[i];
    if (!effect.edit->jumps() || effect.place.cv != state.cv || effect.onset == 0) continue;
    std::vector<Effect> others = effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const VectorXd step =
        state.noise.apply(simulate(effects, state.cv) - simulate(others, state.cv));
    const Index rows = std::min(kShockRows, samples() - effect.onset);
    innovations.segment(effect.onset, rows) += step.segment(effect.onset, rows);
  }
  return innovations;
}

void Problem::settle(const std::vector<Effect>& effects, const Fit* fit) {
  const ModelSpec model = with(effects);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    make_nuisances(model, effects, cv);
    CvData& data = data_[static_cast<std::size_t>(cv)];
    data.weights = rows_with_past(data.known, data.runs, noise_.order);
    if (fit)
      for (const CvFit& state : fit->cvs)
        if (state.cv == cv) reweigh(with_shocks(state, effects), data.weights);
    data.rows = static_cast<double>((data.weights.array() > 0.0).count());
  }
}

VectorXd Problem::simulate(const std::vector<Effect>& effects, int cv) {
  ModelSpec model = model_;
  VectorXd simulated;
  bool stale = true;
  // Effects with an onset come last: each adds what it changes from its onset on.
  for (const Effect& effect : effects)
    if (effect.onset == 0 || effect.edit->knows_onset()) apply(effect, surroundings_, model);
  for (const Effect& effect : effects) {
    if (effect.onset == 0 || effect.edit->knows_onset() || !touches(effect, model, cv)) continue;
    if (stale) simulated = simulator_.cv(model, cv);
    const VectorXd before = simulator_.cv(model, cv);
    apply(effect, surroundings_, model);
    const Index after = before.size() - effect.onset;
    if (after > 0) simulated.tail(after) += (simulator_.cv(model, cv) - before).tail(after);
    stale = false;
  }
  if (stale) simulated = simulator_.cv(model, cv);
  for (const Effect& effect : effects)
    if (effect.shape && effect.place.cv == cv)
      for (std::size_t i = 0; i < effect.coordinates.size(); ++i)
        simulated += effect.coordinates[i].value * effect.shape->col(static_cast<Index>(i));
  return simulated;
}

VectorXd Problem::sensitivity(const std::vector<Effect>& effects, std::size_t effect,
                              std::size_t coordinate, int cv, const VectorXd& at) {
  std::vector<Effect> moved = effects;
  Coordinate& c = moved[effect].coordinates[coordinate];
  const double step = c.value + c.step > c.high ? -c.step : c.step;
  c.value += step;
  return (simulate(moved, cv) - at) * (c.prior_sd / step);
}

MatrixXd Problem::nuisances(const std::vector<Effect>& effects, int cv) const {
  const CvData& data = this->data(cv);
  MatrixXd result = data.nuisances;
  for (std::size_t b = 0; b < data.meaning.size(); ++b)
    for (const Effect& effect : effects)
      if (effect.onset == 0 && effect.place.cv == cv && data.meaning[b].input >= 0 &&
          effect.place.input == data.meaning[b].input && effect.find(*data.meaning[b].quantity))
        result.col(static_cast<Index>(b)).setZero();
  return result;
}

void Problem::update(CvFit& state, const VectorXd& simulated, const MatrixXd& nuisances) const {
  const CvData& data = this->data(state.cv);
  state.residual = (data.measured - simulated - nuisances * state.beta).cwiseProduct(data.known);
  state.noise = fit_whitening(state.residual, data.weights, noise_);
  state.noise.borders = recording().borders;
  state.innovations = state.noise.apply(state.residual);
  const double variance =
      state.innovations.cwiseAbs2().dot(data.weights) / std::max(1.0, data.rows);
  state.variance =
      variance < kLeastVariance ? kLeastVariance : variance;  // stays NaN where the model is none
}

double Problem::cost_with_noise_of(const Fit& fit, const std::vector<Effect>& effects) {
  double cost = 0.0;
  for (const CvFit& state : fit.cvs) {
    const CvData& data = this->data(state.cv);
    const MatrixXd small = nuisances(effects, state.cv);
    const Index samples = data.measured.size(), count = small.cols();
    const WhitenedRows rows_of(data, state);
    MatrixXd system = MatrixXd::Zero(samples + count, count + 1);
    for (Index b = 0; b < count; ++b) system.col(b).head(samples) = rows_of(small.col(b));
    system.col(count).head(samples) = rows_of(data.measured - simulate(effects, state.cv));
    system.bottomLeftCorner(count, count).setIdentity();
    const MatrixXd r = triangle(system);
    cost += r(count, count) * r(count, count);
    for (Index b = 0; b < count; ++b) cost += 2.0 * std::log(std::abs(r(b, b)));
  }
  return cost;
}

Index Problem::best_onset(const Fit& fit, Index first, Index last) {
  // With everything else held: what the rows before an onset cost without the effect, those after
  // it with the effect, and the few rows whose past lies on both sides.
  std::vector<Effect> without(fit.effects.begin(), fit.effects.end() - 1);
  std::vector<Effect> always = fit.effects;
  always.back().onset = 0;
  const Index samples = this->samples();
  VectorXd cost = VectorXd::Zero(last - first + 1);
  for (const CvFit& state : fit.cvs) {
    const CvData& data = this->data(state.cv);
    const VectorXd before = simulate(without, state.cv);
    const VectorXd change = (simulate(always, state.cv) - before).cwiseProduct(data.known);
    const VectorXd base = (data.measured - before - nuisances(fit.effects, state.cv) * state.beta)
                              .cwiseProduct(data.known);
    const VectorXd old = state.noise.apply(base), moved = state.noise.apply(base - change);
    VectorXd head = VectorXd::Zero(samples + 1), tail = VectorXd::Zero(samples + 1);
    for (Index k = 0; k < samples; ++k) head(k + 1) = head(k) + data.weights(k) * old(k) * old(k);
    for (Index k = samples - 1; k >= 0; --k)
      tail(k) = tail(k + 1) + data.weights(k) * moved(k) * moved(k);
    for (Index onset = first; onset <= last; ++onset) {
      const Index mixed_end = std::min<Index>(samples, onset + noise_.order);
      double sum = head(onset) + tail(mixed_end);
      for (Index k = onset; k < mixed_end; ++k) {
        double value = base(k) - change(k);
        for (Index l = 1; l <= noise_.order && l <= k; ++l)
          value -= state.noise.coefficients(l - 1) *
                   (base(k - l) - (k - l >= onset ? change(k - l) : 0.0));
        sum += data.weights(k) * value * value;
      }
      cost(onset - first) += sum / state.variance;
    }
  }
  Index best = 0;
  cost.minCoeff(&best);
  return first + best;
}

std::vector<int> touched(const Effect& effect, const Problem& problem) {
  std::vector<int> cvs;
  for (int cv = 0; cv < problem.model().cv_count; ++cv)
    if (touches(effect, problem.model(), cv)) cvs.push_back(cv);
  return cvs;
}

}  // namespace mpm
