#include "core/nonlinear/nonlinear_regression.hpp"

#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/nonlinear/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

namespace limits = calibration::nonlinear_test;

constexpr int kTogether = 32;

}  // namespace

NonlinearRegression::NonlinearRegression(const RegressionShape& shape, int cv,
                                         const LinearModel& model, NonlinearTest test,
                                         const MemoryLength& memory, int patience)
    : shape_(shape),
      cv_(cv),
      companions_(shape, patience + 1),
      terms_(model, cv, shape.tail_poles.front(), test, patience + 1),
      memory_(past_at() + past(), memory),
      batch_(memory_.factor.columns() + 1, kTogether),
      patience_(patience),
      left_out_(linear_columns(), terms_.columns()),
      lead_in_(static_cast<std::size_t>(shape.lead_in())),
      past_factor_(past(), 1),
      coefficients_(Eigen::VectorXd::Zero(memory_.factor.columns())),
      taken_off_(Eigen::VectorXd::Zero(past())),
      own_past_(Eigen::VectorXd::Zero(shape.past())),
      rotated_(Eigen::VectorXd::Zero(terms_.columns())) {
  set_.reserve(static_cast<std::size_t>(terms_.columns()));
}

void NonlinearRegression::add_sample(const RegressionHistory& history) {
  if (!begun_) return;
  advance(history, 0);
  waiting_ = std::min(waiting_ + 1, patience_ + 1);
}

void NonlinearRegression::add_gap(int missing, const RegressionHistory& history) {
  if (!begun_) return;
  for (int age = missing - 1; age >= 0; --age) advance(history, age);
}

void NonlinearRegression::advance(const RegressionHistory& history, int age) {
  companions_.advance(history, age);
  terms_.advance(history, age);
}

void NonlinearRegression::take(const RegressionHistory& history,
                               const ResidualRegression& regression) {
  const RegressionMemory& linear = regression.memory(0);
  if (begun_ && regression.restarts() != restarts_) begun_ = false;
  const bool grown =
      begun_ && linear.rows >= 2 * rows_at_begin_ && 2 * rows_at_begin_ <= history.depth();
  if (!begun_ || grown) {
    waiting_ = 0;
    if (linear.ready()) begin(history, regression);
    return;
  }
  for (int age = waiting_ - 1; age >= 0; --age) feed(history, regression, age, age);
  flush();
  waiting_ = 0;
}

bool NonlinearRegression::ready() const {
  return begun_ && memory_.ready() &&
         memory_.rows >= limits::kRowsPerColumn * memory_.factor.columns();
}

void NonlinearRegression::begin(const RegressionHistory& history,
                                const ResidualRegression& regression) {
  const int span = std::min(regression.span(), history.settled());
  if (span < 2) return;
  memory_.clear();
  companions_.begin(history);
  terms_.begin(history, span);
  for (int age = history.depth() - 1; age >= 0; --age) {
    advance(history, age);
    if (age < span) feed(history, regression, age, 0);
  }
  flush();
  begun_ = true;
  rows_at_begin_ = std::max(regression.memory(0).rows, 1);
  restarts_ = regression.restarts();
}

void NonlinearRegression::feed(const RegressionHistory& history,
                               const ResidualRegression& regression, int age, int term_age) {
  const double weight = regression.row_weight(age);
  if (!(weight > 0.0)) return;
  const int columns = memory_.factor.columns();
  double* const row = batch_.row(batched_);
  history.fill_lead_in(cv_, age, lead_in_.data());
  double* at = row;
  *at++ = lead_in_.front();
  at = std::copy(lead_in_.begin() + 1 + past(), lead_in_.end(), at);
  history.fill_inputs(age, at);
  companions_.fill(term_age, row + shape_.columns() - past());
  terms_.fill(term_age, row + linear_columns());
  std::copy_n(lead_in_.begin() + 1, past(), row + past_at());
  row[columns] = history.residual(cv_, age);
  for (int c = 0; c <= columns; ++c) row[c] *= weight;
  if (++batched_ == kTogether) flush();
}

void NonlinearRegression::archive(Archive& a) {
  // not archived: shape_, cv_, patience_ (construction)
  // not archived: batch_, batched_ (empty between calls)
  // not archived: left_out_, set_, lead_in_, past_factor_, coefficients_, taken_off_, own_past_,
  // rotated_, own_gain_, error_variance_, freedom_, linear_square_ (each evaluation begins anew)
  a(companions_, terms_, memory_, begun_, rows_at_begin_, restarts_);
  a.within(waiting_, 0, patience_ + 1);
}

void NonlinearRegression::flush() {
  if (batched_ > 0) memory_.take(batch_, batched_);
  batched_ = 0;
}

// The residual's past stands behind the terms, so that their part of the factor is theirs alone,
// and what they say of the residual less any combination of its past is read off: z - sum_l a_l
// R(terms, l), with a squared error of |R_past (a - a_full)|^2 beside the full one's.
void NonlinearRegression::read(Past which) {
  const GivensQr& factor = memory_.factor;
  if (which == Past::kWithoutTerms) {
    without_terms();
  } else {
    factor.solve(0, factor.columns(), coefficients_);
    taken_off_ = coefficients_.segment(past_at(), past());
  }
  for (int r = 0; r < terms_.columns(); ++r) {
    rotated_(r) = factor.z(linear_columns() + r, 0);
    for (int l = 0; l < past(); ++l)
      rotated_(r) -= taken_off_(l) * factor.r(linear_columns() + r, past_at() + l);
  }
  left_out_.read(factor, rotated_);
  linear_square_ = 0.0;
  for (int r = shape_.lead_in() - past(); r < linear_columns(); ++r) {
    double rotated = factor.z(r, 0);
    for (int l = 0; l < past(); ++l) rotated -= taken_off_(l) * factor.r(r, past_at() + l);
    linear_square_ += rotated * rotated;
  }
  double left = factor.residual_square(0);
  for (int r = 0; r < past(); ++r) {
    double difference = factor.z(past_at() + r, 0);
    for (int l = r; l < past(); ++l)
      difference -= taken_off_(l) * factor.r(past_at() + r, past_at() + l);
    left += difference * difference;
  }
  coefficients_.segment(1, past()) = taken_off_;
  shape_.own_past(cv_, coefficients_, own_past_);
  own_gain_ = std::max(1.0 - own_past_.sum(), calibration::curvature::kLeastOwnGain);
  freedom_ = memory_.freedom();
  error_variance_ = left / memory_.weight_sum * memory_.effective_rows() / freedom_ *
                    memory_.weight_square / memory_.weight_sum * limits::kInflation;
}

double NonlinearRegression::chance(const LeftOut::Loss& loss) const {
  if (loss.columns == 0 || !(error_variance_ > 0.0)) return 1.0;
  return f_upper_tail(loss.square / error_variance_ / loss.columns, loss.columns, freedom_);
}

// The past's coefficients where the terms are left out: their rows of the factor are then rows of
// the past's like any other.
void NonlinearRegression::without_terms() {
  past_factor_.clear();
  for (int r = linear_columns(); r < memory_.factor.columns(); ++r) {
    double* row = past_factor_.row();
    for (int l = 0; l < past(); ++l)
      *row++ = past_at() + l < r ? 0.0 : memory_.factor.r(r, past_at() + l);
    *row = memory_.factor.z(r, 0);
    past_factor_.update(1.0);
  }
  past_factor_.solve(0, past(), taken_off_);
}

// Of all terms together.
double NonlinearRegression::any() const {
  LeftOut::Loss all{left_out_.explained(), 0};
  for (int c = 0; c < terms_.columns(); ++c) all.columns += left_out_.live(c) ? 1 : 0;
  return chance(all);
}

// The noise's own past is what is found without the terms, unless the terms surely say something:
// each slow column beside it makes the noise seem to forget faster than it does (Kendall 1954), and
// what it has left then passes for theirs. Where they do say something, without them it seems to
// forget slower.
void NonlinearRegression::evaluate(double variation, ChannelNonlinearity* results) {
  read(Past::kWithoutTerms);
  if (any() < limits::kSurelySomething) read(Past::kBesideTerms);
  judge(variation, results);
}

void NonlinearRegression::judge(double variation, ChannelNonlinearity* results) {
  double most = 0.0;
  for (int i = 0; i < shape_.inputs; ++i) {
    ChannelNonlinearity& result = results[i];
    result = {.tested = true};
    set_.clear();
    for (int c = 0; c < terms_.columns(); ++c)
      if (terms_.has(c, i)) set_.push_back(c);
    const LeftOut::Loss loss = left_out_.loss(set_);
    if (loss.columns == 0 || !(error_variance_ > 0.0)) continue;
    const double beyond = loss.square / error_variance_;
    result.p_value = chance(loss);
    result.statistic = beyond / loss.columns;
    result.share = std::max(0.0, beyond - loss.columns) / memory_.effective_rows();
    const double reference = terms_.coefficient_of(i, variation) * own_gain_;
    const double seen = left_out_.loss_of(set_, terms_.square_of(i), reference) / error_variance_;
    if (seen > 0.0)
      result.smallest_variation = std::min(variation * limits::kSeenDeviations / std::sqrt(seen),
                                           ChannelNonlinearity::kMostVariation);
    if (result.p_value < limits::kKindPValue) result.kind = kind_of(i);
    result.material = loss.square > limits::kLeak * linear_square_;
    most = std::max(most, result.share);
  }
  for (int i = 0; i < shape_.inputs; ++i)
    results[i].material = results[i].material && results[i].share > limits::kMaterialShare &&
                          results[i].share > limits::kShareOfMost * most;
}

// Of the columns with the input in them the kind whose loss is the least likely by chance.
NonlinearKind NonlinearRegression::kind_of(int input) {
  NonlinearKind likeliest = NonlinearKind::kNone;
  double least = 2.0;
  for (const NonlinearKind kind :
       {NonlinearKind::kInputCurve, NonlinearKind::kHysteresis, NonlinearKind::kChannelCurve,
        NonlinearKind::kInteraction, NonlinearKind::kOutputCurve}) {
    set_.clear();
    for (int c = 0; c < terms_.columns(); ++c)
      if (terms_.has(c, input) && terms_.kind(c) == kind) set_.push_back(c);
    const LeftOut::Loss loss = left_out_.loss(set_);
    if (loss.columns == 0) continue;
    const double p_value = chance(loss);
    if (p_value < least) {
      least = p_value;
      likeliest = kind;
    }
  }
  return likeliest;
}

}  // namespace mpm
