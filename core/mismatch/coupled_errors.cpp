#include "core/mismatch/coupled_errors.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/mismatch/calibration.hpp"
#include "core/mismatch/volterra_terms.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

namespace coupled = calibration::coupled_errors;

constexpr double kHalf = 0.5;  // of a square, a triangle

// Columns before the inputs' blocks, at most.
int most_lead_in(const RegressionShape& shape) {
  return shape.lead_in() + VolterraTerms::most_columns();
}

// Of the response and the shifts of the first CV's channels, all but the errors.
int responses_of(const RegressionShape& shape) { return 1 + shape.inputs * InputErrors::kShifts; }

}  // namespace

// Each row of a member's factor is mixed, of which the errors of a channel are in one block alone,
// and rotated into that of [lead-in | errors], which is then rotated into the one of all.
double CoupledErrors::work_of(const RegressionShape& shape, int cvs) {
  const double block = shape.block(), inputs = shape.inputs, errors = cvs * inputs * kUsualErrors;
  const double rows = most_lead_in(shape) + inputs * block;
  const double dense = 1.0 + cvs * shape.residual_order + shape.means();
  const double mixed = block * (errors + responses_of(shape) - 1.0) + inputs * block * dense;
  const double columns = most_lead_in(shape) + errors;
  return cvs * (rows * (mixed + kHalf * columns * columns) + kHalf * errors * errors * errors);
}

double CoupledErrors::numbers_of(const RegressionShape& shape) {
  const double cvs = most_cvs(shape), block = shape.block(), inputs = shape.inputs;
  const double errors = cvs * inputs * kUsualErrors, responses = responses_of(shape);
  const double columns = most_lead_in(shape) + errors;
  const double mixed = errors + responses + cvs * shape.residual_order + shape.means();
  return cvs * columns * (columns + responses) + errors * (errors + responses) +
         std::pow(columns + block, 2) + std::pow(errors + block, 2) +
         inputs * block * (mixed + cvs * (1.0 + shape.past()));
}

int CoupledErrors::most_cvs(const RegressionShape& shape) {
  int most = std::min(shape.cvs, coupled::kMostCvs);
  while (most > 1 && work_of(shape, most) > coupled::kMostWork) --most;
  return most;
}

CoupledErrors::CoupledErrors(const RegressionShape& shape)
    : shape_(shape),
      lead_in_(most_lead_in(shape)),
      errors_(most_cvs(shape) * own_columns()),
      sizes_(Eigen::VectorXd::Zero(errors_)),
      next_(sizes_),
      past_(Eigen::VectorXd::Zero(shape.past())),
      one_(past_),
      none_(past_),
      error_(Eigen::VectorXd::Zero(shape.block())),
      not_delayed_(error_),
      delayed_(static_cast<std::size_t>(most_cvs(shape)),
               Eigen::MatrixXd::Zero(shape.inputs * shape.block(), 1 + shape.past())),
      columns_(Eigen::MatrixXd::Zero(
          shape.inputs * shape.block(),
          errors_ + responses_of(shape) + most_cvs(shape) * shape.residual_order + shape.means())),
      factor_row_(Eigen::VectorXd::Zero(lead_in_ + shape.inputs * shape.block())),
      mixed_(Eigen::VectorXd::Zero(columns_.cols())),
      coefficients_(factor_row_),
      norms_(Eigen::VectorXd::Zero(shape.inputs * shape.block())),
      feed_(lead_in_ + errors_ + shape.block() + responses_of(shape)),
      all_(errors_, responses_of(shape)),
      open_(lead_in_ + errors_ - kUsualErrors + shape.block(), 1),
      freed_(errors_ + shape.block(), 1),
      single_(errors_) {
  for (int m = 0; m < most_cvs(shape); ++m) {
    member_.emplace_back(lead_in_ + errors_, responses_of(shape));
    member_.back().lead_in.setZero(lead_in_);
  }
}

void CoupledErrors::add(int cv, const GivensQr& factor, const EstimateNoise& noise) {
  Member& member = member_[static_cast<std::size_t>(members_++)];
  member.cv = cv;
  member.factor = &factor;
  member.noise = noise;
}

// Noise of all members gets the variance of the first one's.
double CoupledErrors::scale_of(const Member& member) const {
  return std::sqrt(member_.front().noise.variance / member.noise.variance);
}

bool CoupledErrors::fit(const std::vector<ChannelSignatures>& signatures,
                        const InputEstimates& estimates) {
  signatures_ = &signatures;
  held_ = -1;
  sizes_.setZero();
  for (const Member& member : members())
    if (!(member.noise.variance > 0.0 &&
          member.noise.freedom >= calibration::joint_errors::kFreedomPerColumn * shape_.columns()))
      return false;
  for (Member& member : members()) begin(member);
  return descend(estimates) && std::ranges::all_of(members(), [&](const Member& member) {
           return adequate(member, estimates);
         });
}

void CoupledErrors::fit_without(int input, const CoupledErrors& all,
                                const InputEstimates& estimates) {
  signatures_ = all.signatures_;
  held_ = input;
  members_ = all.members_;
  for (std::size_t m = 0; m < members().size(); ++m) {
    member_[m].cv = all.member_[m].cv;
    member_[m].factor = all.member_[m].factor;
    member_[m].noise = all.member_[m].noise;
    member_[m].lead_in = all.member_[m].lead_in;
  }
  sizes_ = all.sizes_;
  sizes_.segment(input * kUsualErrors, kUsualErrors).setZero();
  descend(estimates);
}

bool CoupledErrors::descend(const InputEstimates& estimates) {
  bool settled = false;
  for (int turn = 0; turn < coupled::kTurns && !settled; ++turn) {
    for (std::size_t m = 0; m < members().size(); ++m) delay_errors(m, estimates);
    all_.clear();
    for (Member& member : members()) {
      linearise(member, estimates);
      take_rows(member);
    }
    const double moved = solve();
    for (Member& member : members()) learn_lead_in(member);
    settled = moved < coupled::kSettled * member_.front().noise.variance;
  }
  for (std::size_t m = 0; m < members().size(); ++m) delay_errors(m, estimates);
  return settled;
}

double CoupledErrors::left_square() const {
  double sum = 0.0;
  for (const Member& member : std::span(member_).first(static_cast<std::size_t>(members_)))
    sum += std::pow(scale_of(member), 2) * left_square(member);
  return sum;
}

// With the noise's dynamics as the regression on everything has them.
void CoupledErrors::begin(Member& member) {
  const int lead_in = lead_in_of(member);
  auto coefficients = coefficients_.head(member.factor->columns());
  member.factor->solve(0, member.factor->columns(), coefficients);
  member.lead_in.setZero();
  member.lead_in.head(lead_in) = coefficients.head(lead_in);
}

// Of a member's errors, as large as they are taken to be: not delayed, delayed by each lag, and as
// the means have them.
void CoupledErrors::delay_errors(std::size_t at, const InputEstimates& estimates) {
  const Member& member = member_[at];
  Eigen::MatrixXd& delayed = delayed_[at];
  delayed.setZero();
  for (int i = 0; i < shape_.inputs; ++i) {
    if (!estimates.moved(i)) continue;
    const std::vector<Signature>& errors = signatures_of(member, i).errors;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double size = sizes_(static_cast<Eigen::Index>(at) * own_columns() + i * kUsualErrors +
                                 static_cast<Eigen::Index>(k));
      if (size == 0.0) continue;
      auto own = delayed.middleRows(i * shape_.block(), shape_.block());
      errors[k].filter(none_.data(), not_delayed_);
      own.col(0) += size * not_delayed_;
      for (int delay = 0; delay < shape_.past(); ++delay) {
        one_.setZero();
        one_(delay) = 1.0;
        errors[k].filter(one_.data(), error_);
        own.col(1 + delay) += size * (not_delayed_ - error_);
      }
    }
  }
}

// What an error does to a CV's innovation, by `past_`: the CV's own error, or another's.
void CoupledErrors::act(const Signature& error, bool own, Eigen::Ref<Eigen::VectorXd> out) {
  error.filter(past_.data(), out);
  if (own) return;
  error.filter(none_.data(), not_delayed_);
  out -= not_delayed_;
}

// Columns: all errors; the response's correction and the shifts; the lags of the members' residuals
// and the means, by which they differ from those of the noise.
void CoupledErrors::linearise(const Member& member, const InputEstimates& estimates) {
  columns_.setZero();
  const int block = shape_.block(), order = shape_.residual_order;
  const int response = errors_, lags = errors_ + responses_of(shape_);
  for (int m = 0; m < members_; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Member& other = member_[at];
    const bool own = &other == &member;
    past_.head(order) = member.lead_in.segment(shape_.lags_of(other.cv), order);
    past_.tail(shape_.means()).setZero();
    if (own) past_.tail(shape_.means()) = member.lead_in.segment(shape_.means_at(), shape_.means());
    for (int i = 0; i < shape_.inputs; ++i) {
      if (!estimates.moved(i)) continue;
      const ChannelSignatures& channel = signatures_of(other, i);
      const auto write = [&](const std::vector<Signature>& errors, int column) {
        for (const Signature& error : errors)
          act(error, own, columns_.col(column++).segment(i * block, block));
      };
      if (m > 0 || i != held_) write(channel.errors, m * own_columns() + i * kUsualErrors);
      if (m == 0) write(channel.shifts, response + 1 + i * InputErrors::kShifts);
    }
    columns_.middleCols(lags + m * order, order) = delayed_[at].middleCols(1, order);
    if (!own) continue;
    columns_.col(response) = delayed_[at].col(0);
    columns_.rightCols(shape_.means()) = delayed_[at].rightCols(shape_.means());
  }
  columns_.col(response).noalias() -=
      columns_.leftCols(members_ * own_columns()) * sizes_.head(members_ * own_columns());
}

// The errors and shifts of a channel are in its input's block alone.
void CoupledErrors::mix_row(const Member& member, int r) {
  const GivensQr& factor = *member.factor;
  const int all = factor.columns(), lead_in = lead_in_of(member), block = shape_.block();
  factor_row_.head(r).setZero();
  factor_row_.segment(r, all - r) =
      factor.root(r) * Eigen::Map<const Eigen::VectorXd>(factor.unit_row(r), all - r);
  mixed_.head(errors_ + responses_of(shape_)).setZero();
  for (int i = std::max(0, r - lead_in) / block; i < shape_.inputs; ++i) {
    const auto own = factor_row_.segment(lead_in + i * block, block);
    const auto mix = [&](int column, int count) {
      mixed_.segment(column, count).noalias() =
          columns_.block(i * block, column, block, count).transpose() * own;
    };
    for (int m = 0; m < members_; ++m) mix(m * own_columns() + i * kUsualErrors, kUsualErrors);
    mix(errors_ + 1 + i * InputErrors::kShifts, InputErrors::kShifts);
  }
  const auto row = factor_row_.segment(lead_in, shape_.inputs * block);
  const int lags = static_cast<int>(mixed_.size()) - errors_ - responses_of(shape_);
  mixed_(errors_) = columns_.col(errors_).dot(row);
  mixed_.tail(lags).noalias() = columns_.rightCols(lags).transpose() * row;
}

void CoupledErrors::write_lead_in(const Member& member, double* out) const {
  const int lead_in = lead_in_of(member), order = shape_.residual_order;
  std::copy_n(factor_row_.data(), lead_in, out);
  std::fill(out + lead_in, out + lead_in_, 0.0);
  const double* delayed = mixed_.data() + errors_ + responses_of(shape_);
  for (int m = 0; m < members_; ++m) {
    double* lags = out + shape_.lags_of(member_[static_cast<std::size_t>(m)].cv);
    for (int l = 0; l < order; ++l) lags[l] -= *delayed++;
  }
  const double* means = mixed_.data() + mixed_.size() - shape_.means();
  for (int t = 0; t < shape_.means(); ++t) out[shape_.means_at() + t] -= means[t];
}

void CoupledErrors::take_rows(Member& member) {
  member.row.clear();
  const int shifts = shape_.inputs * InputErrors::kShifts;
  for (int r = 0; r < member.factor->columns(); ++r) {
    mix_row(member, r);
    double* row = feed_.next_row(member.row);
    write_lead_in(member, row);
    row += lead_in_;
    std::copy_n(mixed_.data(), errors_, row);
    row[errors_] = member.factor->z(r, 0) - mixed_(errors_);
    std::copy_n(mixed_.data() + errors_ + 1, shifts, row + errors_ + 1);
  }
  feed_.flush(member.row);
  const double scale = scale_of(member);
  for (int r = 0; r < errors_; ++r) {
    double* row = feed_.next_row(all_);
    std::fill(row, row + r, 0.0);
    for (int c = r; c < errors_; ++c) row[c] = scale * member.row.r(lead_in_ + r, lead_in_ + c);
    for (int s = 0; s < 1 + shifts; ++s) row[errors_ + s] = scale * member.row.z(lead_in_ + r, s);
  }
  feed_.flush(all_);
}

// By how much that moves what is explained, in squares.
double CoupledErrors::solve() {
  all_.solve(0, errors_, next_);
  double square = 0.0;
  for (int r = 0; r < errors_; ++r) {
    double moved = 0.0;
    for (int c = r; c < errors_; ++c) moved += all_.r(r, c) * (next_(c) - sizes_(c));
    square += moved * moved;
  }
  sizes_ = next_;
  return square;
}

void CoupledErrors::learn_lead_in(Member& member) const {
  for (int r = lead_in_ - 1; r >= 0; --r) {
    double left = member.row.z(r, 0);
    for (int c = r + 1; c < lead_in_; ++c) left -= member.row.r(r, c) * member.lead_in(c);
    for (int c = 0; c < errors_; ++c) left -= member.row.r(r, lead_in_ + c) * sizes_(c);
    const double own = member.row.r(r, r);
    member.lead_in(r) = own > 0.0 ? left / own : 0.0;
  }
}

double CoupledErrors::left_square(const Member& member) const {
  double square = member.row.residual_square(0);
  for (int r = 0; r < errors_; ++r) {
    double left = member.row.z(lead_in_ + r, 0);
    for (int c = r; c < errors_; ++c) left -= member.row.r(lead_in_ + r, lead_in_ + c) * sizes_(c);
    square += left * left;
  }
  return square;
}

bool CoupledErrors::adequate(const Member& member, const InputEstimates& estimates) const {
  int moving = 0, own = 0;
  for (int i = 0; i < shape_.inputs; ++i) {
    if (!estimates.moved(i)) continue;
    moving += shape_.block();
    own += static_cast<int>(signatures_of(member, i).errors.size());
  }
  const double left = moving - own;
  return left > 0.0 &&
         f_upper_tail(left_square(member) / (left * member.noise.block_variance), left,
                      member.noise.freedom) > calibration::joint_errors::kAdequatePValue;
}

CoupledErrors::Freed CoupledErrors::freed(int input, const InputEstimates& estimates) {
  const int own = input * kUsualErrors, others = errors_ - kUsualErrors, block = shape_.block();
  const auto to = [&](int c) {  // the channel's own errors behind all others
    if (c < own) return c;
    return c < own + kUsualErrors ? others + c - own : c - kUsualErrors;
  };
  freed_.clear();
  for (int m = 1; m < members_; ++m) {
    const Member& member = member_[static_cast<std::size_t>(m)];
    const double scale = scale_of(member);
    for (int r = 0; r < errors_; ++r) {
      double* row = feed_.next_row(freed_);
      std::fill(row, row + errors_ + block, 0.0);
      for (int c = r; c < errors_; ++c)
        row[to(c)] = scale * member.row.r(lead_in_ + r, lead_in_ + c);
      row[errors_ + block] = scale * member.row.z(lead_in_ + r, 0);
    }
    feed_.flush(freed_);
  }
  const Member& first = member_.front();
  linearise(first, estimates);
  open_.clear();
  for (int r = 0; r < first.factor->columns(); ++r) {
    mix_row(first, r);
    double* row = feed_.next_row(open_);
    write_lead_in(first, row);
    row += lead_in_;
    for (int c = 0; c < errors_; ++c)
      if (to(c) < others) row[to(c)] = mixed_(c);
    Eigen::Map<Eigen::VectorXd>(row + others, block) =
        factor_row_.segment(lead_in_of(first) + input * block, block)
            .cwiseProduct(estimates.scales(input));
    row[others + block] = first.factor->z(r, 0) - mixed_(errors_);
  }
  feed_.flush(open_);
  for (int r = 0; r < others + block; ++r) {
    double* row = feed_.next_row(freed_);
    std::fill(row, row + errors_ + block, 0.0);
    for (int c = r; c < others + block; ++c)
      row[c < others ? c : c + kUsualErrors] = open_.r(lead_in_ + r, lead_in_ + c);
    row[errors_ + block] = open_.z(lead_in_ + r, 0);
  }
  feed_.flush(freed_);
  return {freed_, errors_};
}

}  // namespace mpm
