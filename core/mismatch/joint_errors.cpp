#include "core/mismatch/joint_errors.hpp"

#include <algorithm>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/volterra_terms.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

constexpr int kShifts = InputErrors::kShifts;

}  // namespace

JointErrors::JointErrors(const RegressionShape& shape)
    : shape_(shape),
      moved_(Eigen::MatrixXd::Zero(shape.inputs * shape.block(), shape.inputs * kUsualErrors)),
      shifts_(Eigen::MatrixXd::Zero(moved_.rows(), shape.inputs * kShifts)),
      errors_(Eigen::MatrixXd::Zero(shape.block(), shape.inputs * kUsualErrors)),
      error_(Eigen::VectorXd::Zero(shape.block())),
      sizes_(Eigen::VectorXd::Zero(shape.inputs * kUsualErrors)),
      lead_in_(Eigen::VectorXd::Zero(shape.lead_in() + VolterraTerms::most_columns())),
      own_past_(Eigen::VectorXd::Zero(shape.past())),
      learnt_(own_past_),
      feed_(shape.inputs * (kUsualErrors + kShifts) + shape.block() + 1),
      all_(shape.inputs * kUsualErrors, 1 + shape.inputs * kShifts),
      freed_((shape.inputs - 1) * kUsualErrors + shape.block(), 1),
      single_(shape.inputs * kUsualErrors) {}

void JointErrors::read(int cv, const GivensQr& factor,
                       const std::vector<ChannelSignatures>& signatures, const EstimateNoise& noise,
                       InputEstimates& estimates) {
  own_past_ = estimates.own_past();
  fit(cv, signatures, noise, estimates);
  for (int turn = 0; turn < calibration::joint_errors::kTurns; ++turn) {
    const double before = all_.residual_square(0);
    learn_own_lags(factor);
    shape_.own_past(cv, lead_in_, learnt_);
    estimates.set_own_past(learnt_);
    fit(cv, signatures, noise, estimates);
    if (before - all_.residual_square(0) <
        calibration::joint_errors::kWorthAnotherTurn * noise.variance)
      break;
  }
  adequate_ =
      adequate_ && noise.freedom >= calibration::joint_errors::kFreedomPerColumn * shape_.columns();
  if (!adequate_) estimates.set_own_past(own_past_);
}

// The lead-in's coefficients where the inputs' are those of the fit: R_l^-1 (z_l - R_li X x).
void JointErrors::learn_own_lags(const GivensQr& factor) {
  all_.solve(0, all_.columns(), sizes_);
  const int lead_in = factor.columns() - shape_.inputs * shape_.block();
  for (int r = lead_in - 1; r >= 0; --r) {
    double left = factor.z(r, 0);
    for (int c = r + 1; c < lead_in; ++c) left -= factor.r(r, c) * lead_in_(c);
    for (int i = 0; i < shape_.inputs; ++i) {
      const auto own = errors_.middleCols(i * kUsualErrors, kUsualErrors);
      for (int l = 0; l < shape_.block(); ++l)
        left -= factor.r(r, lead_in + i * shape_.block() + l) *
                own.row(l).dot(sizes_.segment(i * kUsualErrors, kUsualErrors));
    }
    const double own = factor.r(r, r);
    lead_in_(r) = own > 0.0 ? left / own : 0.0;
  }
}

void JointErrors::fit(int cv, const std::vector<ChannelSignatures>& signatures,
                      const EstimateNoise& noise, const InputEstimates& estimates) {
  move(cv, estimates, signatures);
  all_.clear();
  const int columns = all_.columns();
  for (Eigen::Index r = 0; r < moved_.rows(); ++r) {
    double* row = feed_.next_row(all_);
    for (int c = 0; c < columns; ++c) row[c] = moved_(r, c);
    row[columns] = estimates.rotated()(r);
    for (int c = 0; c < all_.responses() - 1; ++c) row[columns + 1 + c] = shifts_(r, c);
  }
  feed_.flush(all_);
  int moving = 0;
  for (int i = 0; i < shape_.inputs; ++i) moving += estimates.moved(i) ? shape_.block() : 0;
  int rank = 0;
  for (int c = 0; c < columns; ++c) rank += all_.root(c) > 0.0 ? 1 : 0;
  const double left = moving - rank;
  adequate_ = rank > 0 && noise.variance > 0.0 && left > 0.0 &&
              f_upper_tail(all_.residual_square(0) / (left * noise.block_variance), left,
                           noise.freedom) > calibration::joint_errors::kAdequatePValue;
}

// R_t X and R_t s, column by column; errors that a channel lacks are zero.
void JointErrors::move(int cv, const InputEstimates& estimates,
                       const std::vector<ChannelSignatures>& signatures) {
  moved_.setZero();
  shifts_.setZero();
  errors_.setZero();
  for (int i = 0; i < shape_.inputs; ++i) {
    if (!estimates.moved(i)) continue;
    const ChannelSignatures& channel = signatures[static_cast<std::size_t>(i * shape_.cvs + cv)];
    const auto move_all = [&](const std::vector<Signature>& errors, Eigen::MatrixXd& out, int at) {
      for (const Signature& error : errors) {
        error.filter(estimates.own_past().data(), error_);
        if (&out == &moved_) errors_.col(at) = error_;
        error_.array() *= estimates.norms(i).array();
        estimates.move(i, error_, out.col(at++));
      }
    };
    move_all(channel.errors, moved_, i * kUsualErrors);
    move_all(channel.shifts, shifts_, i * kShifts);
  }
}

JointErrors::Freed JointErrors::freed(int input, const InputEstimates& estimates) {
  freed_.clear();
  const int others = (shape_.inputs - 1) * kUsualErrors;
  const int own = input * kUsualErrors;
  for (Eigen::Index r = 0; r < moved_.rows(); ++r) {
    double* row = feed_.next_row(freed_);
    for (int c = 0; c < others; ++c) row[c] = moved_(r, c < own ? c : c + kUsualErrors);
    estimates.triangle_row(static_cast<int>(r), input, row + others);
    row[others + shape_.block()] = estimates.rotated()(r);
  }
  feed_.flush(freed_);
  return {freed_, others};
}

}  // namespace mpm
