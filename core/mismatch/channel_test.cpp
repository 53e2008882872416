#include "core/mismatch/channel_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/regression/rotation.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

// A column of which less than this share (relative s.d.) is its own is held at that share: the
// variances of everything that depends on it then come out huge instead of meaningless.
constexpr double kOwnShare = 1e-7;

// Above this own share of every column the regression's coefficients are worth reading.
constexpr double kSeparable = 1e-3;

// Rows over which the noise level is followed, and the error in s.d. beyond which a row is trusted
// less (science: about 300 rows and 3 s.d. keep both calibration and power).
constexpr double kScaleRows = 300.0;
constexpr double kClip = 3.0;

// Room for the usual errors of a channel, and the share of one that must be its own to count.
constexpr int kMostUsualErrors = 8;
constexpr double kIndependent = 1e-6;

// The other inputs mask this one where they make its gain's s.d. this many times larger.
constexpr double kMasked = 2.0;

}  // namespace

ChannelTest::Response::Response(int columns)
    : factor(columns, 1), coefficients(Eigen::VectorXd::Zero(columns)) {}

ChannelTest::ChannelTest(const Shape& shape, double lambda, const LinearModel& model)
    : shape_(shape),
      lambda_(lambda),
      block_(shape.fir_lags + static_cast<int>(shape.tail_poles.size())),
      lead_in_(1 + shape.cvs * shape.residual_order),
      columns_(lead_in_ + shape.inputs * block_),
      origin_(Eigen::VectorXd::Zero(shape.inputs)),
      last_input_(Eigen::VectorXd::Zero(shape.inputs)),
      row_(columns_),
      evidence_(static_cast<std::size_t>(shape.inputs * shape.cvs)) {
  if (shape.inputs < 1 || shape.cvs < 1 || shape.fir_lags < 1 || shape.residual_order < 1 ||
      shape.tail_poles.empty() || !(lambda > 0.0 && lambda <= 1.0))
    throw std::invalid_argument("impossible shape of the channel test");
  const int tails = static_cast<int>(shape.tail_poles.size());
  for (int i = 0; i < shape.inputs; ++i) {
    input_windows_.emplace_back(shape.fir_lags);
    for (int t = 0; t < tails; ++t) tail_windows_.emplace_back(shape.fir_lags + 1);
  }
  for (int j = 0; j < shape.cvs; ++j) {
    residual_windows_.emplace_back(shape.residual_order);
    responses_.emplace_back(columns_);
  }

  const BlockBasis basis(shape.fir_lags, shape.tail_poles);
  const Eigen::MatrixXd gains = model.steady_gain();
  const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating = model.integrating();
  for (int i = 0; i < shape.inputs; ++i) {
    for (int j = 0; j < shape.cvs; ++j) {
      Channel channel;
      const Eigen::VectorXd pulse = model.impulse_response(j, i, basis.length());
      if (pulse.cwiseAbs().maxCoeff() > 0.0) {
        channel.gain = gains(j, i) * (integrating(j, i) ? basis.slowest() : 1.0);
        for (const Eigen::VectorXd& error : usual_errors(pulse))
          channel.errors.emplace_back(basis, error, shape.residual_order);
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
  inverse_.setZero(padded_, padded_);
  covariance_.setZero(block_, block_);
  behind_.setZero(block_, all);
  norms_.setZero(all);
  scales_.setZero(all);
  rotated_.setZero(all);
  estimate_.setZero(all);
  direction_.setZero(block_, shape.inputs);
  usual_.setZero(block_, kMostUsualErrors);
  beta_.setZero(block_);
  whitened_.setZero(block_);
  whitened_beta_.setZero(block_);
  functional_.setZero(all);
  other_functional_.setZero(all);
}

double ChannelTest::effective_rows() const {
  return weight_square_ > 0.0 ? weight_sum_ * weight_sum_ / weight_square_ : 0.0;
}

bool ChannelTest::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                         const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  const int tails = static_cast<int>(shape_.tail_poles.size());
  if (!has_origin_) {
    origin_ = inputs;
    has_origin_ = true;
  }
  const bool full = filled_ > std::max(shape_.fir_lags, shape_.residual_order);
  if (full) {
    build_row();
    for (int j = 0; j < shape_.cvs; ++j) take_row(j, residuals(j));
    weight_sum_ = lambda_ * weight_sum_ + 1.0;
    weight_square_ = lambda_ * lambda_ * weight_square_ + 1.0;
    ++rows_;
  }
  for (int i = 0; i < shape_.inputs; ++i) {
    const double u = inputs(i) - origin_(i);
    input_windows_[static_cast<std::size_t>(i)].push(u);
    for (int t = 0; t < tails; ++t) {
      LagWindow& window = tail_windows_[static_cast<std::size_t>(i * tails + t)];
      const double pole = shape_.tail_poles[static_cast<std::size_t>(t)];
      window.push(pole * window.window()[0] + (1.0 - pole) * u);
    }
  }
  last_input_ = inputs - origin_;
  for (int j = 0; j < shape_.cvs; ++j)
    residual_windows_[static_cast<std::size_t>(j)].push(residuals(j));
  ++filled_;
  return full;
}

void ChannelTest::skip(std::int64_t missing) {
  const int tails = static_cast<int>(shape_.tail_poles.size());
  filled_ = 0;
  for (int i = 0; i < shape_.inputs; ++i) {
    for (int t = 0; t < tails; ++t) {
      LagWindow& window = tail_windows_[static_cast<std::size_t>(i * tails + t)];
      const double kept =
          std::pow(shape_.tail_poles[static_cast<std::size_t>(t)], static_cast<double>(missing));
      window.push(kept * window.window()[0] + (1.0 - kept) * last_input_(i));
    }
  }
}

void ChannelTest::build_row() {
  const int tails = static_cast<int>(shape_.tail_poles.size());
  double* out = row_.data();
  *out++ = 1.0;
  for (const LagWindow& residual : residual_windows_)
    out = std::copy_n(residual.window(), shape_.residual_order, out);
  for (int i = 0; i < shape_.inputs; ++i) {
    out = std::copy_n(input_windows_[static_cast<std::size_t>(i)].window(), shape_.fir_lags, out);
    for (int t = 0; t < tails; ++t)
      *out++ = tail_windows_[static_cast<std::size_t>(i * tails + t)].window()[shape_.fir_lags];
  }
}

void ChannelTest::take_row(int cv, double residual) {
  Response& response = responses_[static_cast<std::size_t>(cv)];
  GivensQr& factor = response.factor;
  double* out = factor.row();
  std::copy_n(row_.data(), columns_, out);
  out[columns_] = residual;
  if (response.scaled) {
    for (int c = 0; c <= columns_; ++c) out[c] /= response.scale;
    const GivensQr::Preview preview = factor.preview(lambda_);
    const double error = std::abs(preview.error) * std::sqrt(preview.share);  // in s.d.
    const double clipped = std::min(error, kClip);
    if (error > clipped)
      for (int c = 0; c <= columns_; ++c) out[c] *= clipped / error;
    response.scale_rows = std::min(response.scale_rows + 1.0, kScaleRows);
    response.scale *= std::sqrt(1.0 + (clipped * clipped - 1.0) / response.scale_rows);
  }
  factor.update(lambda_);

  // The first rows come as they are; once they are twice as many as the columns they give the
  // first estimate of the noise level, by which they are then divided like all that follow.
  if (!response.scaled && rows_ + 1 >= 2 * columns_) {
    const double freedom = effective_rows() - columns_;
    const double mean_square =
        factor.residual_square(0) / weight_sum_ * (freedom + columns_) / std::max(freedom, 1.0);
    if (mean_square > 0.0) {
      response.scale = std::sqrt(mean_square);
      response.scale_rows = std::min(std::max(freedom, 1.0), kScaleRows);
      factor.scale(1.0 / response.scale);
      response.scaled = true;
    }
  }
}

void ChannelTest::evaluate() {
  if (!ready()) return;
  for (int j = 0; j < shape_.cvs; ++j) evaluate_cv(j);
}

void ChannelTest::evaluate_cv(int cv) {
  Response& response = responses_[static_cast<std::size_t>(cv)];
  const GivensQr& factor = response.factor;
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
    estimate_(i) = inverse_.row(i).segment(i, all - i).dot(rotated_.tail(all - i));

  // A_j of the regression on everything, where everything can be told apart; otherwise of the one
  // on the residual lags alone: a loop without excitation makes inputs a function of residuals.
  double least_share = 1.0;
  for (int c = 0; c < all; ++c) least_share = std::min(least_share, triangle_(c, c));
  factor.solve(0, least_share > kSeparable ? columns_ : lead_in_, response.coefficients);

  const double freedom = denominator_freedom();
  const double variance = factor.residual_square(0) / weight_sum_ * (freedom + columns_) / freedom;
  const double inflation = weight_square_ / weight_sum_;
  for (int i = 0; i < shape_.inputs; ++i) {
    ChannelEvidence& evidence = evidence_[static_cast<std::size_t>(i * shape_.cvs + cv)];
    const int at = i * block_;
    const int live = static_cast<int>((norms_.segment(at, block_).array() > 0.0).count());
    if (live < block_ || !(variance > 0.0)) {
      evidence = ChannelEvidence{};
      evidence.excitation_index = std::numeric_limits<double>::infinity();
      evidence.excitation_index_alone = std::numeric_limits<double>::infinity();
      direction_.col(i).setZero();
      continue;
    }
    factor_covariance(i);
    whitened_ = estimate_.segment(at, block_);
    whiten(whitened_);
    evidence.tests = 1;
    evidence.numerator_freedom = block_;
    evidence.block_statistic = whitened_.squaredNorm() / (block_ * variance * inflation);
    evidence.statistic = evidence.block_statistic;
    evidence.p_value = f_upper_tail(evidence.statistic, evidence.numerator_freedom, freedom);
    judge_usual_errors(cv, i, variance * inflation, freedom, evidence);

    const Channel& channel = channels_[static_cast<std::size_t>(i * shape_.cvs + cv)];
    evidence.reference_gain = reference_gain(cv, i);
    channel.errors.front().filter(own_lags(cv), beta_);
    if (channel.gain == 0.0) beta_ *= evidence.reference_gain;
    beta_.array() *= norms_.segment(at, block_).array();
    functional_.head(at + block_).noalias() = triangle_.block(0, at, at + block_, block_) * beta_;
    const double alone = functional_.head(at + block_).squaredNorm();
    whitened_beta_ = beta_;
    whiten(whitened_beta_);
    const double information = whitened_beta_.squaredNorm();
    const double spread = std::sqrt(variance * inflation);
    evidence.excitation_index = spread / std::sqrt(information);
    evidence.excitation_index_alone = spread / std::sqrt(alone);
    evidence.gain_error_ratio =
        information > 0.0 ? whitened_beta_.dot(whitened_) / information : 0.0;
    whiten_transposed(whitened_beta_);
    direction_.col(i) = whitened_beta_;
  }
  for (int i = 0; i < shape_.inputs; ++i) {
    ChannelEvidence& evidence = evidence_[static_cast<std::size_t>(i * shape_.cvs + cv)];
    const bool masked = evidence.excitation_index > kMasked * evidence.excitation_index_alone;
    evidence.confounder = masked ? find_confounder(i) : -1;
  }
}

const double* ChannelTest::own_lags(int cv) const {
  return responses_[static_cast<std::size_t>(cv)].coefficients.data() + 1 +
         cv * shape_.residual_order;
}

void ChannelTest::judge_usual_errors(int cv, int input, double variance, double freedom,
                                     ChannelEvidence& evidence) {
  const Channel& channel = channels_[static_cast<std::size_t>(input * shape_.cvs + cv)];
  if (channel.gain == 0.0) return;  // of a channel that the model lacks no error is usual
  int rank = 0;
  double explained = 0.0;
  for (const Signature& error : channel.errors) {
    error.filter(own_lags(cv), beta_);
    beta_.array() *= norms_.segment(input * block_, block_).array();
    whiten(beta_);
    const double before = beta_.norm();
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan; Parlett 1980)
      for (int c = 0; c < rank; ++c) beta_ -= usual_.col(c).dot(beta_) * usual_.col(c);
    const double after = beta_.norm();
    if (!(after > kIndependent * before)) continue;
    usual_.col(rank) = beta_ / after;
    const double part = usual_.col(rank).dot(whitened_);
    explained += part * part;
    ++rank;
  }
  if (rank == 0) return;
  const double statistic = explained / (rank * variance);
  const double p_value = f_upper_tail(statistic, rank, freedom);
  if (p_value < evidence.p_value) {
    evidence.p_value = p_value;
    evidence.statistic = statistic;
    evidence.numerator_freedom = rank;
  }
  evidence.p_value = std::min(1.0, 2.0 * evidence.p_value);
  evidence.tests = 2;
}

double ChannelTest::reference_gain(int cv, int input) const {
  const double own = channels_[static_cast<std::size_t>(input * shape_.cvs + cv)].gain;
  if (own != 0.0) return own;
  double largest = 0.0;
  for (int i = 0; i < shape_.inputs; ++i) {
    const double gain = channels_[static_cast<std::size_t>(i * shape_.cvs + cv)].gain;
    largest = std::max(largest, std::abs(gain) * norms_(i * block_));
  }
  if (largest == 0.0)
    largest = responses_[static_cast<std::size_t>(cv)].factor.centred_norm(
        1 + cv * shape_.residual_order);
  return largest / norms_(input * block_);
}

void ChannelTest::invert_triangle() {
  constexpr int kGranule = static_cast<int>(kRowGranule);
  std::array<const double*, kRowGranule> rows{};
  for (int i = shape_.inputs * block_ - 1; i >= 0; --i) {
    double* out = inverse_.row(i).data();
    std::fill(out + i + 1, out + padded_, 0.0);
    int c = i + 1;
    for (; c % kGranule != 0; ++c) {
      const double* row = inverse_.row(c).data();
      project_row(row + c, out + c, static_cast<std::size_t>(padded_ - c), triangle_(i, c));
    }
    for (; c < padded_; c += kGranule) {  // row c has zeros before column c
      for (int a = 0; a < kGranule; ++a)
        rows[static_cast<std::size_t>(a)] = inverse_.row(c + a).data() + c;
      project_rows(rows.data(), out + c, static_cast<std::size_t>(padded_ - c),
                   triangle_.row(i).data() + c);
    }
    const double inverse = 1.0 / (norms_(i) > 0.0 ? std::max(triangle_(i, i), kOwnShare) : 1.0);
    for (int k = i + 1; k < padded_; ++k) out[k] *= inverse;
    out[i] = inverse;
  }
}

void ChannelTest::factor_covariance(int input) {
  const int at = input * block_;
  const int behind = (shape_.inputs - 1 - input) * block_;
  covariance_ = inverse_.block(at, at, block_, block_);
  if (behind == 0) return;
  behind_.leftCols(behind) = inverse_.block(at, at + block_, block_, behind);
  // Last row first: the rows above have nothing in the triangle's columns that are done.
  for (int r = block_ - 1; r >= 0; --r) {
    auto row = behind_.row(r).head(behind);
    const double own = covariance_(r, r);
    const double norm = std::sqrt(own * own + row.squaredNorm());
    const double first = own + norm;  // own > 0; the reflector is [first, row]
    const double scale = 1.0 / (norm * first);
    for (int c = 0; c < r; ++c) {
      auto other = behind_.row(c).head(behind);
      const double share = (covariance_(c, r) * first + other.dot(row)) * scale;
      covariance_(c, r) -= share * first;
      other -= share * row;
    }
    covariance_(r, r) = -norm;
  }
}

void ChannelTest::whiten(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = block_ - 1; r >= 0; --r) {
    const int rest = block_ - 1 - r;
    x(r) = (x(r) - covariance_.row(r).tail(rest).dot(x.tail(rest))) / covariance_(r, r);
  }
}

void ChannelTest::whiten_transposed(Eigen::Ref<Eigen::VectorXd> x) const {
  for (int r = 0; r < block_; ++r) {
    const int rest = block_ - 1 - r;
    x(r) /= covariance_(r, r);
    x.tail(rest) -= x(r) * covariance_.row(r).tail(rest).transpose();
  }
}

void ChannelTest::gain_functional(int input, Eigen::Ref<Eigen::VectorXd> functional) const {
  const int at = input * block_;
  functional.head(at).setZero();
  functional.tail(functional.size() - at).noalias() =
      inverse_.block(at, at, block_, functional.size() - at).transpose() * direction_.col(input);
}

int ChannelTest::find_confounder(int input) {
  gain_functional(input, functional_);
  int confounder = -1;
  double largest = 0.0;
  for (int other = 0; other < shape_.inputs; ++other) {
    if (other == input) continue;
    gain_functional(other, other_functional_);
    const double norm = other_functional_.norm();
    if (!(norm > 0.0)) continue;
    const double correlation = std::abs(functional_.dot(other_functional_)) / norm;
    if (correlation > largest) {
      largest = correlation;
      confounder = other;
    }
  }
  return confounder;
}

}  // namespace mpm
