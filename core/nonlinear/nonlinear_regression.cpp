#include "core/nonlinear/nonlinear_regression.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/archive/archive.hpp"
#include "core/mismatch/calibration.hpp"
#include "core/nonlinear/calibration.hpp"
#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

namespace nonlinear_test = calibration::nonlinear_test;

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
      shares_(kTogether, 1.0),
      patience_(patience),
      selection_(linear_columns(), terms_.columns()),
      chances_(static_cast<std::size_t>(terms_.groups())),
      taken_(static_cast<std::size_t>(terms_.groups())),
      blamed_(static_cast<std::size_t>(shape.inputs)),
      lead_in_(static_cast<std::size_t>(shape.lead_in())),
      past_factor_(past(), 1),
      coefficients_(Eigen::VectorXd::Zero(memory_.factor.columns())),
      taken_off_(Eigen::VectorXd::Zero(past())),
      own_past_(Eigen::VectorXd::Zero(shape.past())),
      rotated_(Eigen::VectorXd::Zero(terms_.columns())) {}

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
         memory_.rows >= nonlinear_test::kRowsPerColumn * memory_.factor.columns();
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
  shares_[static_cast<std::size_t>(batched_)] = regression.row_share(age);
  if (++batched_ == kTogether) flush();
}

void NonlinearRegression::archive(Archive& a) {
  // not archived: shape_, cv_, patience_ (construction)
  // not archived: batch_, shares_, batched_ (empty between calls)
  // not archived: selection_, taken_, blamed_, bend_square_, lead_in_, past_factor_, coefficients_,
  // taken_off_, own_past_, rotated_, own_gain_, error_variance_, freedom_, linear_square_, chances_
  // (each evaluation begins anew)
  a(companions_, terms_, memory_, begun_, rows_at_begin_, restarts_);
  a.within(waiting_, 0, patience_ + 1);
}

void NonlinearRegression::flush() {
  if (batched_ > 0) memory_.take(batch_, shares_.data(), batched_);
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
  selection_.read(factor, rotated_);
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
                    memory_.weight_square / memory_.weight_sum * nonlinear_test::kInflation;
}

// Beside what the past is now taken to say, and beside what it was found to say without terms.
double NonlinearRegression::chance(int group, const TermSelection::Gain& gain) const {
  return std::max(chance(gain), chances_[static_cast<std::size_t>(group)]);
}

double NonlinearRegression::chance(const TermSelection::Gain& gain) const {
  if (gain.columns == 0 || !(error_variance_ > 0.0)) return 1.0;
  return f_upper_tail(gain.square / error_variance_ / gain.columns, gain.columns, freedom_);
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

// The noise's own past is what is found without the terms, unless the terms surely say something:
// each slow column beside it makes the noise seem to forget faster than it does (Kendall 1954), and
// what it has left then passes for theirs. Where they do say something, without them it seems to
// forget slower; but of noise that wanders they seem to say so, and then, beside them, anything. So
// nothing is blamed that the past found without them would not blame.
void NonlinearRegression::evaluate(double rate, double variation, ChannelNonlinearity* results) {
  read(Past::kWithoutTerms);
  for (int g = 0; g < terms_.groups(); ++g)
    chances_[static_cast<std::size_t>(g)] = chance(selection_.gain(terms_.columns_of_group(g)));
  if (chance(selection_.all()) < nonlinear_test::kSurelySomething) read(Past::kBesideTerms);
  for (int i = 0; i < shape_.inputs; ++i) results[i] = {.tested = true};
  std::fill(taken_.begin(), taken_.end(), false);
  std::fill(blamed_.begin(), blamed_.end(), false);
  bend_square_ = 0.0;
  if (!(error_variance_ > 0.0)) return;
  for (;;) {
    see(variation, results);
    const Explanation best = best_explanation(rate, results);
    if (best.group < 0) return;
    blame(best, results);
  }
}

// The weakest square of each input not blamed that would be seen beside what is taken in.
void NonlinearRegression::see(double variation, ChannelNonlinearity* results) const {
  for (int i = 0; i < shape_.inputs; ++i) {
    if (blamed_[static_cast<std::size_t>(i)]) continue;
    const double seen = terms_.coefficient_of(i, variation) * own_gain_ *
                        selection_.norm_left(terms_.square_of(i)) / std::sqrt(error_variance_);
    results[i].smallest_variation = ChannelNonlinearity::kMostVariation;
    if (seen > 0.0)
      results[i].smallest_variation = std::min(variation * nonlinear_test::kSeenDeviations / seen,
                                               ChannelNonlinearity::kMostVariation);
  }
}

// Of those by which an input that is not blamed yet would be.
NonlinearRegression::Explanation NonlinearRegression::best_explanation(
    double rate, ChannelNonlinearity* results) {
  for (int i = 0; i < shape_.inputs; ++i)
    if (!blamed_[static_cast<std::size_t>(i)])
      results[i] = {.tested = true, .smallest_variation = results[i].smallest_variation};
  Explanation best;
  double most = 0.0;
  for (int g = 0; g < terms_.groups(); ++g) {
    if (taken_[static_cast<std::size_t>(g)] || all_blamed(g)) continue;
    const TermSelection::Gain gain = selection_.gain(terms_.columns_of_group(g));
    if (gain.columns == 0) continue;
    look_at(g, gain, results);
    double p_value = 1.0;
    for (int i = 0; i < shape_.inputs; ++i)
      if (!blamed_[static_cast<std::size_t>(i)] && terms_.has(g, i))
        p_value = std::min(p_value, groups_with(i) * chance(g, gain));
    if (!(p_value < rate) || !matters(gain)) continue;
    const double worth =
        gain.square / error_variance_ - gain.columns * std::log(memory_.effective_rows());
    if (best.group >= 0 && worth <= most) continue;
    most = worth;
    best = {g, gain};
  }
  return best;
}

// As many groups are asked about an input, and the best one counts (Bonferroni).
void NonlinearRegression::look_at(int group, const TermSelection::Gain& gain,
                                  ChannelNonlinearity* results) const {
  const double chance_of = chance(group, gain);
  for (int i = 0; i < shape_.inputs; ++i) {
    if (blamed_[static_cast<std::size_t>(i)] || !terms_.has(group, i)) continue;
    const double p_value = std::min(1.0, groups_with(i) * chance_of);
    if (results[i].statistic > 0.0 && p_value >= results[i].p_value) continue;
    results[i].p_value = p_value;
    results[i].statistic = gain.square / error_variance_ / gain.columns;
    results[i].share =
        std::max(0.0, gain.square / error_variance_ - gain.columns) / memory_.effective_rows();
  }
}

int NonlinearRegression::groups_with(int input) const {
  int count = 0;
  for (int g = 0; g < terms_.groups(); ++g) count += terms_.has(g, input) ? 1 : 0;
  return count;
}

bool NonlinearRegression::matters(const TermSelection::Gain& gain) const {
  const double share = (gain.square / error_variance_ - gain.columns) / memory_.effective_rows();
  return share > nonlinear_test::kMaterialShare &&
         gain.square > nonlinear_test::kLeak * linear_square_ &&
         gain.square > nonlinear_test::kShareOfBend * bend_square_;
}

bool NonlinearRegression::all_blamed(int group) const {
  for (int i = 0; i < shape_.inputs; ++i)
    if (terms_.has(group, i) && !blamed_[static_cast<std::size_t>(i)]) return false;
  return true;
}

void NonlinearRegression::blame(const Explanation& best, ChannelNonlinearity* results) {
  const double p_chance = chance(best.group, best.gain);
  for (int i = 0; i < shape_.inputs; ++i) {
    if (!terms_.has(best.group, i) || blamed_[static_cast<std::size_t>(i)]) continue;
    blamed_[static_cast<std::size_t>(i)] = true;
    ChannelNonlinearity& result = results[i];
    result.p_value = std::min(1.0, groups_with(i) * p_chance);
    result.statistic = best.gain.square / error_variance_ / best.gain.columns;
    result.share = 0.0;
    result.kind = terms_.kind(best.group);
    result.material = true;
  }
  take(best.group, results);
  // Beside a bend that is known a curve of all inputs together is what its terms leave over.
  for (int g = 0; g < terms_.groups(); ++g)
    if (!taken_[static_cast<std::size_t>(g)] &&
        (all_blamed(g) || terms_.kind(g) == NonlinearKind::kOutputCurve))
      take(g, results);
}

void NonlinearRegression::take(int group, ChannelNonlinearity* results) {
  taken_[static_cast<std::size_t>(group)] = true;
  const TermSelection::Gain gain = selection_.take(terms_.columns_of_group(group));
  bend_square_ += gain.square;
  const double share =
      std::max(0.0, gain.square / error_variance_ - gain.columns) / memory_.effective_rows();
  for (int i = 0; i < shape_.inputs; ++i)
    if (terms_.has(group, i) && blamed_[static_cast<std::size_t>(i)]) results[i].share += share;
}

// The coefficient of a function is the sum of its columns' over the lags, by what the residual's
// own past leaves of a constant.
std::vector<CurvePoint> NonlinearRegression::input_curve(int input) const {
  using calibration::nonlinear_curve::kPoints;
  using calibration::nonlinear_curve::kReach;
  int group = 0;
  while (!(terms_.kind(group) == NonlinearKind::kInputCurve && terms_.has(group, input))) ++group;
  const std::vector<int>& columns = terms_.columns_of_group(group);
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd triangle(terms_.columns(), count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const int column = columns[static_cast<std::size_t>(c)];
    for (int r = 0; r < terms_.columns(); ++r)
      triangle(r, c) =
          r <= column ? memory_.factor.r(linear_columns() + r, linear_columns() + column) : 0.0;
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(triangle);
  const Eigen::MatrixXd inverse = factor.pseudoInverse();
  const Eigen::VectorXd coefficients = inverse * rotated_;
  std::vector<double> functions(columns.size());
  std::vector<CurvePoint> curve;
  for (int p = 0; p < kPoints; ++p) {
    const double x = kReach * (2.0 * p / (kPoints - 1) - 1.0);
    terms_.input_functions(input, x, functions.data());
    const Eigen::Map<const Eigen::VectorXd> at(functions.data(), count);
    curve.push_back({terms_.input_at(input, x), at.dot(coefficients) / own_gain_,
                     std::sqrt(error_variance_) * (inverse.transpose() * at).norm() / own_gain_});
  }
  return curve;
}

}  // namespace mpm
