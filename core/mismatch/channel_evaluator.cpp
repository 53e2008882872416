#include "core/mismatch/channel_evaluator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/mismatch/box_least_squares.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/regression/rotation.hpp"
#include "core/statistics/f_distribution.hpp"
#include "core/statistics/normal.hpp"

namespace mpm {
namespace {

using calibration::rounding::kIndependentShare;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Columns of `generators_`.
enum Generator : int { kGain, kTime, kLater, kEarlier, kGenerators };

// Norms of the rows of R^-1, R upper triangular: the estimates' s.d. for unit noise. Columns that
// have nothing of their own take no part and get infinity.
Eigen::Vector3d inverse_row_norms(const Eigen::Matrix3d& r) {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int c = 0; c < 3; ++c) {
    if (r(c, c) == 0.0) continue;
    inverse(c, c) = 1.0 / r(c, c);
    for (int i = c - 1; i >= 0; --i) {
      if (r(i, i) == 0.0) continue;
      double sum = 0.0;
      for (int k = i + 1; k <= c; ++k) sum += r(i, k) * inverse(k, c);
      inverse(i, c) = -sum / r(i, i);
    }
  }
  Eigen::Vector3d norms = inverse.rowwise().norm();
  for (int c = 0; c < 3; ++c)
    if (r(c, c) == 0.0) norms(c) = kInfinity;
  return norms;
}

// min |c - R x| with x(2) >= 0: where the free minimum has it negative, it is 0.
Eigen::Vector3d fit_with_shift(const Eigen::Matrix3d& r, const Eigen::Vector3d& c) {
  const auto solve = [&](double last) {
    Eigen::Vector3d x(0.0, 0.0, last);
    for (int i = 1; i >= 0; --i)
      if (r(i, i) > 0.0) x(i) = (c(i) - r.row(i).tail(2 - i).dot(x.tail(2 - i))) / r(i, i);
    return x;
  };
  return solve(r(2, 2) > 0.0 ? std::max(c(2) / r(2, 2), 0.0) : 0.0);
}

// p-value of |parameter| <= limit: Student's t of the excess, one-sided.
double beyond_limit(const Estimate& estimate, double limit, double freedom) {
  const double excess = (std::abs(estimate.value) - limit) / estimate.deviation;
  return excess > 0.0 ? 0.5 * f_upper_tail(excess * excess, 1.0, freedom) : 1.0;
}

bool surely_within(const Estimate& estimate, double limit) {
  return std::abs(estimate.value) + kNormalOneSided95 * estimate.deviation < limit;
}

}  // namespace

ChannelEvaluator::ChannelEvaluator(const RegressionShape& shape, const LinearModel& model,
                                   std::vector<MaterialityLimits> limits)
    : shape_(shape), block_(shape.block()), lead_in_(shape.lead_in()) {
  const auto channels = static_cast<std::size_t>(shape.inputs * shape.cvs);
  if (limits.size() == 1) limits.resize(channels, limits.front());
  if (limits.size() != channels)
    throw std::invalid_argument("materiality limits: one per channel, or one for all");

  const BlockBasis basis(shape.fir_lags, shape.tail_poles);
  const Eigen::MatrixXd gains = model.steady_gain();
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating = model.integrating();
  for (int i = 0; i < shape.inputs; ++i) {
    for (int j = 0; j < shape.cvs; ++j) {
      Channel channel;
      channel.limits = limits[static_cast<std::size_t>(i * shape.cvs + j)];
      const Eigen::VectorXd pulse = model.impulse_response(j, i, basis.length());
      if (pulse.cwiseAbs().maxCoeff() > 0.0) {
        channel.gain = gains(j, i) * (integrating(j, i) ? basis.slowest() : 1.0);
        for (const Eigen::VectorXd& error : usual_errors(pulse))
          channel.errors.emplace_back(basis, error, shape.residual_order);
        for (const int shift : {1, -1})
          channel.shifts.emplace_back(basis, shifted(pulse, shift) - pulse, shape.residual_order);
      } else {
        Eigen::VectorXd lag = Eigen::VectorXd::Zero(basis.length());
        const double pole = std::exp(-1.0 / basis.slowest());
        for (int l = 1; l < basis.length(); ++l) lag(l) = (1.0 - pole) * std::pow(pole, l - 1);
        channel.errors.emplace_back(basis, lag, shape.residual_order);
      }
      channels_.push_back(std::move(channel));
    }
  }

  const int all = shape.inputs * block_;
  constexpr int kGranule = static_cast<int>(kRowGranule);
  padded_ = (all + kGranule - 1) / kGranule * kGranule;
  triangle_.setZero(padded_, padded_);
  const auto width = static_cast<std::size_t>(padded_);
  inverse_ = make_aligned(width * width);
  behind_ = make_aligned(static_cast<std::size_t>(block_) * width);
  shares_.assign(static_cast<std::size_t>(block_), 0.0);
  covariance_.setZero(block_, block_);
  norms_.setZero(all);
  scales_.setZero(all);
  rotated_.setZero(all);
  estimate_.setZero(all);
  coefficients_.setZero(shape.columns());
  direction_.setZero(block_, shape.inputs);
  usual_.setZero(block_, kUsualErrors);
  usual_generators_.setZero(kUsualErrors, kGenerators);
  usual_whitened_.setZero(kUsualErrors);
  reduced_basis_.setZero(std::max(block_, kUsualErrors), 3);
  generators_.setZero(block_, kGenerators);
  beta_.setZero(block_);
  whitened_.setZero(block_);
  whitened_beta_.setZero(block_);
  functional_.setZero(all);
  other_functional_.setZero(all);
}

void ChannelEvaluator::evaluate(int cv, const RegressionMemory& memory, ChannelEvidence* evidence) {
  read_factor(cv, memory.factor);
  const double freedom = memory.freedom();
  const double variance = memory.factor.residual_square(0) / memory.weight_sum *
                          (freedom + memory.factor.columns()) / freedom;
  const double inflated = variance * memory.weight_square / memory.weight_sum;
  const double per_freedom = memory.factor.columns() / freedom;
  const Scale scale{inflated * (1.0 + calibration::few_rows::kDirected * per_freedom),
                    inflated * (1.0 + calibration::few_rows::kBlock * per_freedom), freedom};
  for (int i = 0; i < shape_.inputs; ++i) {
    evidence[i] = ChannelEvidence{};
    const auto norms = norms_.segment(i * block_, block_);
    if (norms.minCoeff() > 0.0 && inflated > 0.0) {
      judge(cv, i, scale, evidence[i]);
    } else {
      evidence[i].excitation_index = kInfinity;
      evidence[i].excitation_index_alone = kInfinity;
      direction_.col(i).setZero();
    }
  }
  for (int i = 0; i < shape_.inputs; ++i)
    if (evidence[i].excitation_index >
        calibration::confounding::kMasked * evidence[i].excitation_index_alone)
      find_confounder(i, evidence[i]);
}

void ChannelEvaluator::read_factor(int cv, const GivensQr& factor) {
  const int all = shape_.inputs * block_;
  factor.centred_norms(lead_in_, norms_);
  for (int c = 0; c < all; ++c) scales_(c) = norms_(c) > 0.0 ? 1.0 / norms_(c) : 0.0;
  for (int i = 0; i < all; ++i) {
    const Eigen::Map<const Eigen::RowVectorXd> row(factor.unit_row(lead_in_ + i), all - i);
    triangle_.row(i).segment(i, all - i) =
        (factor.root(lead_in_ + i) * row).cwiseProduct(scales_.tail(all - i).transpose());
    rotated_(i) = factor.z(lead_in_ + i, 0);
  }
  invert_triangle();
  for (int i = 0; i < all; ++i)
    estimate_(i) =
        Eigen::Map<const Eigen::VectorXd>(inverse_row(i) + i, all - i).dot(rotated_.tail(all - i));

  // A_j of the regression on everything, where everything can be told apart; otherwise of the one
  // on the residual lags alone: a loop without excitation makes inputs a function of residuals.
  double least_share = 1.0;
  for (int c = 0; c < all; ++c) least_share = std::min(least_share, triangle_(c, c));
  factor.solve(0,
               least_share > calibration::rounding::kSeparableShare ? shape_.columns() : lead_in_,
               coefficients_);
  own_lags_ = coefficients_.data() + 1 + cv * shape_.residual_order;
  residual_norm_ = factor.centred_norm(1 + cv * shape_.residual_order);
}

void ChannelEvaluator::judge(int cv, int input, const Scale& scale, ChannelEvidence& evidence) {
  const Channel& channel = channels_[static_cast<std::size_t>(input * shape_.cvs + cv)];
  const int at = input * block_;
  input_ = input;
  factor_covariance(input);
  whitened_ = estimate_.segment(at, block_);
  whiten(whitened_);
  evidence.numerator_freedom = block_;
  evidence.block_statistic = whitened_.squaredNorm() / (block_ * scale.block_variance);
  evidence.statistic = evidence.block_statistic;
  evidence.p_value = f_upper_tail(evidence.statistic, evidence.numerator_freedom, scale.freedom);
  evidence.p_value_material = evidence.p_value;
  evidence.reference_gain = reference_gain(cv, input);

  channel.errors.front().filter(own_lags_, beta_);
  if (channel.gain == 0.0) beta_ *= evidence.reference_gain;
  beta_.array() *= norms_.segment(at, block_).array();
  functional_.head(at + block_).noalias() = triangle_.block(0, at, at + block_, block_) * beta_;
  const double alone = functional_.head(at + block_).squaredNorm();
  whitened_beta_ = beta_;
  whiten(whitened_beta_);
  const double information = whitened_beta_.squaredNorm();
  const double spread = std::sqrt(scale.variance);
  evidence.excitation_index = spread / std::sqrt(information);
  evidence.excitation_index_alone = spread / std::sqrt(alone);
  evidence.gain_error_ratio = information > 0.0 ? whitened_beta_.dot(whitened_) / information : 0.0;
  evidence.gain_error = {evidence.gain_error_ratio, evidence.excitation_index};
  direction_.col(input) = whitened_beta_;
  whiten_transposed(direction_.col(input));
  if (channel.gain == 0.0) return;  // of a channel that the model lacks no error is usual

  judge_usual_errors(channel, scale, evidence);
  judge_materiality(channel, scale, evidence);
  if (!evidence.usual) estimate_free_gain(channel, scale, evidence);
}

void ChannelEvaluator::whiten_error(const Signature& error, int input,
                                    Eigen::Ref<Eigen::VectorXd> out) {
  error.filter(own_lags_, out);
  out.array() *= norms_.segment(input * block_, block_).array();
  whiten(out);
}

void ChannelEvaluator::judge_usual_errors(const Channel& channel, const Scale& scale,
                                          ChannelEvidence& evidence) {
  usual_rank_ = 0;
  double explained = 0.0;
  for (std::size_t e = 0; e < channel.errors.size(); ++e) {
    whiten_error(channel.errors[e], input_, beta_);
    if (e == kGain) generators_.col(kGain) = beta_;
    if (e == kTime) generators_.col(kTime) = beta_;
    const double before = beta_.norm();
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan; Parlett 1980)
      for (int c = 0; c < usual_rank_; ++c) beta_ -= usual_.col(c).dot(beta_) * usual_.col(c);
    const double after = beta_.norm();
    if (!(after > kIndependentShare * before)) continue;
    usual_.col(usual_rank_) = beta_ / after;
    const double part = usual_.col(usual_rank_).dot(whitened_);
    explained += part * part;
    ++usual_rank_;
  }
  if (usual_rank_ == 0) return;
  const double statistic = explained / (usual_rank_ * scale.variance);
  const double p_value = f_upper_tail(statistic, usual_rank_, scale.freedom);
  if (p_value < evidence.p_value) {
    evidence.p_value = p_value;
    evidence.statistic = statistic;
    evidence.numerator_freedom = usual_rank_;
  }
  evidence.p_value = std::min(1.0, 2.0 * evidence.p_value);
  evidence.tests = 2;
}

// [gain, time, shift] = Q R by Gram-Schmidt, twice each (Kahan; Parlett 1980), and Q' of the
// target.
ChannelEvaluator::Reduced ChannelEvaluator::reduce(const Eigen::Ref<const Eigen::VectorXd>& target,
                                                   const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                                   int shift) {
  const Eigen::Index rows = target.size();
  Reduced reduced;
  reduced.rest_square = target.squaredNorm();
  int column = 0;
  for (const int generator : {static_cast<int>(kGain), static_cast<int>(kTime), shift}) {
    auto q = reduced_basis_.col(column).head(rows);
    q = columns.col(generator);
    const double before = q.norm();
    for (int pass = 0; pass < 2; ++pass)
      for (int b = 0; b < column; ++b) {
        const double share = reduced_basis_.col(b).head(rows).dot(q);
        reduced.r(b, column) += share;
        q -= share * reduced_basis_.col(b).head(rows);
      }
    const double own = q.norm();
    if (own > kIndependentShare * before) {
      reduced.r(column, column) = own;
      q /= own;
      reduced.c(column) = q.dot(target);
      reduced.rest_square -= reduced.c(column) * reduced.c(column);
    } else {
      q.setZero();
    }
    ++column;
  }
  reduced.rest_square = std::max(reduced.rest_square, 0.0);
  return reduced;
}

void ChannelEvaluator::judge_materiality(const Channel& channel, const Scale& scale,
                                         ChannelEvidence& evidence) {
  whiten_error(channel.shifts[0], input_, generators_.col(kLater));
  whiten_error(channel.shifts[1], input_, generators_.col(kEarlier));
  double nearest = kInfinity;
  for (const int shift : {static_cast<int>(kLater), static_cast<int>(kEarlier)}) {
    const Reduced whole = reduce(whitened_, generators_, shift);
    // Without dead time, a lag that answers earlier is the same lag with more gain.
    if (shift == kEarlier && whole.r(2, 2) == 0.0) continue;
    const Eigen::Vector3d fit = fit_with_shift(whole.r, whole.c);
    const double square = whole.rest_square + (whole.c - whole.r * fit).squaredNorm();
    if (square >= nearest) continue;
    nearest = square;
    const Eigen::Vector3d deviations = std::sqrt(scale.variance) * inverse_row_norms(whole.r);
    evidence.gain_error = {fit(0), deviations(0)};
    evidence.log_time_error = {fit(1), deviations(1)};
    evidence.dead_time_error = {shift == kLater ? fit(2) : -fit(2), deviations(2)};
  }
  const int free = block_ - 3;
  evidence.usual =
      free > 0 && f_upper_tail(nearest / (free * scale.variance), free, scale.freedom) >
                      calibration::usual_errors::kUnusualPValue;
  if (!evidence.usual) {
    judge_unusual(channel.limits, scale, evidence);
    return;
  }
  const MaterialityLimits& limits = channel.limits;
  const double log_time = std::log1p(limits.time_constant);
  const double beyond =
      std::min({beyond_limit(evidence.gain_error, limits.gain, scale.freedom),
                beyond_limit(evidence.log_time_error, log_time, scale.freedom),
                beyond_limit(evidence.dead_time_error, limits.dead_time_samples, scale.freedom)});
  evidence.p_value_material = std::min(1.0, 3.0 * beyond);
  evidence.harmless = surely_within(evidence.gain_error, limits.gain) &&
                      surely_within(evidence.log_time_error, log_time) &&
                      surely_within(evidence.dead_time_error, limits.dead_time_samples);
}

void ChannelEvaluator::judge_unusual(const MaterialityLimits& limits, const Scale& scale,
                                     ChannelEvidence& evidence) {
  // The same directions as the usual errors see them.
  for (int c = 0; c < usual_rank_; ++c) {
    for (int g = 0; g < kGenerators; ++g)
      usual_generators_(c, g) = usual_.col(c).dot(generators_.col(g));
    usual_whitened_(c) = usual_.col(c).dot(whitened_);
  }
  const double log_time = std::log1p(limits.time_constant);
  const Eigen::Vector3d low(-limits.gain, -log_time, 0.0);
  const Eigen::Vector3d high(limits.gain, log_time, limits.dead_time_samples);
  double nearest = kInfinity;
  double nearest_usual = kInfinity;
  for (const int shift : {static_cast<int>(kLater), static_cast<int>(kEarlier)}) {
    const Reduced whole = reduce(whitened_, generators_, shift);
    const Reduced usual =
        reduce(usual_whitened_.head(usual_rank_), usual_generators_.topRows(usual_rank_), shift);
    nearest = std::min(nearest, whole.rest_square +
                                    box_least_squares(whole.r, whole.c, low, high).distance_square);
    nearest_usual =
        std::min(nearest_usual, usual.rest_square +
                                    box_least_squares(usual.r, usual.c, low, high).distance_square);
  }
  const double block_p =
      f_upper_tail(nearest / (block_ * scale.block_variance), block_, scale.freedom);
  const double usual_p =
      f_upper_tail(nearest_usual / (usual_rank_ * scale.variance), usual_rank_, scale.freedom);
  evidence.p_value_material = std::min(1.0, 2.0 * std::min(block_p, usual_p));
}

// The gain as the sum of the block's coefficients over A_j(1): free of the model's shape.
void ChannelEvaluator::estimate_free_gain(const Channel& channel, const Scale& scale,
                                          ChannelEvidence& evidence) {
  double own = 1.0;
  for (int l = 0; l < shape_.residual_order; ++l) own -= own_lags_[l];
  if (!(own > 0.0)) return;  // the noise integrates: no gain can be read off
  const int at = input_ * block_;
  beta_ = scales_.segment(at, block_);  // sum of the unscaled coefficients
  const double sum = beta_.dot(estimate_.segment(at, block_));
  // Its variance is |S' scales|^2; S is upper triangular.
  double square = 0.0;
  for (int c = 0; c < block_; ++c) {
    const double part = covariance_.col(c).head(c + 1).dot(beta_.head(c + 1));
    square += part * part;
  }
  evidence.gain_error = {sum / own / channel.gain,
                         std::sqrt(square * scale.variance) / own / std::abs(channel.gain)};
}

double ChannelEvaluator::reference_gain(int cv, int input) const {
  const double own = channels_[static_cast<std::size_t>(input * shape_.cvs + cv)].gain;
  if (own != 0.0) return own;
  double largest = 0.0;
  for (int i = 0; i < shape_.inputs; ++i) {
    const double gain = channels_[static_cast<std::size_t>(i * shape_.cvs + cv)].gain;
    largest = std::max(largest, std::abs(gain) * norms_(i * block_));
  }
  if (largest == 0.0) largest = residual_norm_;
  return largest / norms_(input * block_);
}

// A granule of rows at a time, the last ones first; what is behind them is subtracted from all of
// them in one go.
void ChannelEvaluator::invert_triangle() {
  constexpr int kGranule = static_cast<int>(kRowGranule);
  const auto all = static_cast<int>(norms_.size());
  const auto width = static_cast<std::size_t>(padded_);
  std::array<const double*, kRowGranule> rows{};
  std::array<double, kRowGranule * kRowGranule> entries{};
  for (int first = padded_ - kGranule; first >= 0; first -= kGranule) {
    const int end = first + kGranule;
    for (int i = first; i < end; ++i)
      std::fill(inverse_row(i) + first, inverse_row(i) + padded_, 0.0);
    for (int c = end; c < padded_; c += kGranule) {  // row c has zeros before column c
      for (int k = 0; k < kGranule; ++k) {
        rows[static_cast<std::size_t>(k)] = inverse_row(c + k) + c;
        std::copy_n(triangle_.row(first + k).data() + c, kGranule, entries.data() + k * kGranule);
      }
      project_block(rows.data(), {inverse_row(first) + c, width, kGranule},
                    static_cast<std::size_t>(padded_ - c), entries.data());
    }
    for (int i = end - 1; i >= first; --i) {
      double* out = inverse_row(i);
      for (int c = i + 1; c < end; ++c)
        project_row(inverse_row(c) + c, out + c, static_cast<std::size_t>(padded_ - c),
                    triangle_(i, c));
      const bool moves = i < all && norms_(i) > 0.0;
      const double inverse =
          moves ? 1.0 / std::max(triangle_(i, i), calibration::rounding::kOwnShare) : 1.0;
      for (int k = i + 1; k < padded_; ++k) out[k] *= inverse;
      out[i] = i < all ? inverse : 0.0;
    }
  }
}

void ChannelEvaluator::factor_covariance(int input) {
  const int at = input * block_;
  const int behind = (shape_.inputs - 1 - input) * block_;
  for (int r = 0; r < block_; ++r)
    covariance_.row(r) = Eigen::Map<const Eigen::RowVectorXd>(inverse_row(at + r) + at, block_);
  if (behind == 0) return;
  const std::size_t stride =
      (static_cast<std::size_t>(behind) + kRowGranule - 1) / kRowGranule * kRowGranule;
  const auto behind_row = [&](int r) {
    return behind_.get() + static_cast<std::size_t>(r) * stride;
  };
  for (int r = 0; r < block_; ++r)
    std::fill(std::copy_n(inverse_row(at + r) + at + block_, behind, behind_row(r)),
              behind_row(r + 1), 0.0);
  // Last row first: the rows above have nothing in the triangle's columns that are done.
  for (int r = block_ - 1; r >= 0; --r) {
    double* row = behind_row(r);
    double square = 0.0;
    inner_products(row, {row, stride, 1}, stride, &square);
    const double own = covariance_(r, r);
    const double norm = std::sqrt(own * own + square);
    const double first = own + norm;  // own > 0; the reflector is [first, row]
    const double scale = 1.0 / (norm * first);
    inner_products(row, {behind_.get(), stride, r}, stride, shares_.data());
    for (int c = 0; c < r; ++c) {
      const double share =
          (covariance_(c, r) * first + shares_[static_cast<std::size_t>(c)]) * scale;
      covariance_(c, r) -= share * first;
      project_row(row, behind_row(c), stride, share);
    }
    covariance_(r, r) = -norm;
  }
}

void ChannelEvaluator::whiten(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = block_ - 1; r >= 0; --r) {
    const int rest = block_ - 1 - r;
    x(r) = (x(r) - covariance_.row(r).tail(rest).dot(x.tail(rest))) / covariance_(r, r);
  }
}

void ChannelEvaluator::whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = 0; r < block_; ++r) {
    const int rest = block_ - 1 - r;
    x(r) /= covariance_(r, r);
    x.tail(rest) -= x(r) * covariance_.row(r).tail(rest).transpose();
  }
}

void ChannelEvaluator::gain_functional(int input, Eigen::Ref<Eigen::VectorXd> functional) const {
  const int at = input * block_;
  functional.head(at).setZero();
  const Eigen::Index rest = functional.size() - at;
  functional.tail(rest).setZero();
  for (int r = 0; r < block_; ++r)
    functional.tail(rest) +=
        direction_(r, input) * Eigen::Map<const Eigen::VectorXd>(inverse_row(at + r) + at, rest);
}

void ChannelEvaluator::find_confounder(int input, ChannelEvidence& evidence) {
  gain_functional(input, functional_);
  double largest = 0.0;
  for (int other = 0; other < shape_.inputs; ++other) {
    if (other == input) continue;
    gain_functional(other, other_functional_);
    const double norm = other_functional_.norm();
    if (!(norm > 0.0)) continue;
    const double correlation = std::abs(functional_.dot(other_functional_)) / norm;
    if (correlation > largest) {
      largest = correlation;
      evidence.confounder = other;
    }
  }
}

}  // namespace mpm
