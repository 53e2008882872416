#include "core/mismatch/change_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

using calibration::change_scan::kMargin;
using calibration::change_scan::kMoments;

}  // namespace

ChangeScan::ChangeScan(const RegressionShape& shape)
    : shape_(shape),
      feed_(shape.columns() + 1),
      whole_(shape.columns(), 1),
      lead_in_(shape.lead_in(), 1),
      one_input_(shape.lead_in() + shape.block(), 1),
      inputs_(Eigen::VectorXd::Zero(shape.inputs * shape.block())),
      after_with_(kMoments),
      after_without_(kMoments),
      before_with_(kMoments),
      before_without_(kMoments) {
  const auto entries =
      static_cast<std::size_t>(shape.lead_in()) * static_cast<std::size_t>(shape.lead_in() + 1);
  for (auto* parts : {&after_with_, &after_without_, &before_with_, &before_without_})
    for (Part& part : *parts) part.triangle.resize(entries);
  moments_.reserve(kMoments);
}

// Of a CV with Volterra terms these are part of the lead-in.
void ChangeScan::take_shape(const ResidualRegression& regression) {
  RegressionShape shape = shape_;
  shape.terms += regression.lead_in() - shape.lead_in();
  if (shape.terms != shape_.terms) *this = ChangeScan(shape);
}

std::optional<ChangePoint> ChangeScan::scan(const MismatchDetector& detector, int cv) {
  const Rows rows{detector.history(), detector.regression(cv), cv};
  if (rows.span() < 2 * kMoments) return std::nullopt;
  take_shape(rows.regression);
  moments_.clear();  // ages at which a part ends, newest first
  for (int m = 1; m < kMoments; ++m) moments_.push_back(m * rows.span() / kMoments);
  pass(rows, true, true, after_with_);
  pass(rows, true, false, after_without_);
  pass(rows, false, true, before_with_);
  pass(rows, false, false, before_without_);
  constant_ = whole_.residual_square(0);
  const double freedom = std::min(rows.regression.memory(0).rows, rows.span()) - shape_.columns();
  if (!(constant_ > 0.0) || freedom <= 0.0) return std::nullopt;
  per_square_ = freedom / constant_;

  const double inputs = shape_.inputs * shape_.block();
  const Curvature* curvature = detector.curvature(cv);
  const double bent = curvature ? calibration::curvature::kBeyondShare * curvature->explained : 0.0;
  const double margin = kMargin + bent;
  const double chance =
      inputs + calibration::change_scan::kChanceDeviations * std::sqrt(2.0 * inputs);
  const int fewest = calibration::change_scan::kRowsPerColumn * shape_.columns();
  const ChangePoint began = strongest(ChangeKind::kBegan, after_with_, before_without_, margin, 0);
  const ChangePoint ended = strongest(ChangeKind::kEnded, after_without_, before_with_, margin, 0);
  ChangePoint best = ended.gain > began.gain ? ended : began;
  const ChangePoint other =
      strongest(ChangeKind::kOther, after_with_, before_with_, best.gain + chance, fewest);
  if (other.samples > 0) best = other;
  if (best.samples == 0) return std::nullopt;
  if (best.kind != ChangeKind::kEnded) name_input(rows, best);
  // The rows between the change and the nearest moment looked at fit neither side of an end; twice
  // as many parameters hide them, and then find nothing in all that came since.
  const bool over = best.kind == ChangeKind::kOther && ended.samples > 0 &&
                    best.p_value > calibration::change_scan::kNothingPValue;
  return over ? ended : best;
}

ChangePoint ChangeScan::strongest(ChangeKind kind, const std::vector<Part>& after,
                                  const std::vector<Part>& before, double least, int fewest) {
  ChangePoint best{kind, 0, 0, least};
  for (std::size_t m = 0; m < moments_.size(); ++m) {
    if (moments_[m] < fewest) continue;
    const double gain = gain_of(after[m], before[m], best.gain);
    if (gain > best.gain)
      best = {kind, moments_[m], moments_[m] - (m > 0 ? moments_[m - 1] : 0), gain};
  }
  return best;
}

// In residual variances, where it can exceed `least` at all: joining the parts only leaves more.
double ChangeScan::gain_of(const Part& after, const Part& before, double least) {
  // Where one side is noisier than all rows together, so is what it gains by chance.
  const double noise =
      std::max({1.0, variance_of(after) * per_square_, variance_of(before) * per_square_});
  const double scale = per_square_ / noise;
  if ((constant_ - after.square - before.square) * scale <= least) return least;
  return (constant_ - joined(after, before)) * scale;
}

// The input that alone explains the rows since the change best, and its F on these rows alone: with
// rows clipped as leniently as above and as strictly as in the test, the larger p. A burst of noise
// passes the first, hardly both.
void ChangeScan::name_input(const Rows& rows, ChangePoint& change) {
  const InputFit lenient = best_input(rows, change.samples, false);
  const InputFit strict = best_input(rows, change.samples, true);
  const InputFit& told = lenient.p_value > strict.p_value ? lenient : strict;
  change.input = lenient.input;
  change.p_value = told.p_value;
  change.statistic = told.statistic;
  change.numerator = told.numerator;
  change.denominator = told.denominator;
}

ChangeScan::InputFit ChangeScan::best_input(const Rows& rows, int samples, bool strict) {
  const double count = fit_input(rows, -1, samples, strict, lead_in_);
  const double nothing = lead_in_.residual_square(0);
  double least = std::numeric_limits<double>::infinity();
  InputFit best;
  for (int input = 0; input < shape_.inputs; ++input) {
    fit_input(rows, input, samples, strict, one_input_);
    if (one_input_.residual_square(0) >= least) continue;
    least = one_input_.residual_square(0);
    best.input = input;
  }
  const int block = shape_.block();
  const double freedom = count - shape_.lead_in() - block;
  if (freedom < calibration::change_scan::kFewestFreedom || !(least > 0.0)) return best;
  best.numerator = block;
  best.denominator = freedom;
  best.statistic = (nothing - least) / block / (least / freedom);
  best.p_value = std::min(1.0, shape_.inputs * f_upper_tail(best.statistic, block, freedom));
  return best;
}

// The last samples' rows on the lead-in and, where `input` >= 0, its block; how many they count
// for.
double ChangeScan::fit_input(const Rows& rows, int input, int samples, bool strict,
                             GivensQr& factor) {
  factor.clear();
  double count = 0.0;
  for (int age = samples - 1; age >= 0; --age) {
    const ResidualRegression& regression = rows.regression;
    const double weight = strict ? regression.row_weight(age) : regression.lenient_weight(age);
    if (!(weight > 0.0)) continue;
    double* row = feed_.next_row(factor);
    rows.regression.fill_lead_in(rows.history, age, row);
    if (input >= 0) {
      rows.history.fill_inputs(age, inputs_.data());
      std::copy_n(inputs_.data() + input * shape_.block(), shape_.block(), row + shape_.lead_in());
    }
    row[factor.columns()] = rows.history.residual(rows.cv, age);
    for (int c = 0; c <= factor.columns(); ++c) row[c] *= weight;
    count += strict ? regression.row_share(age) : 1.0;
  }
  feed_.flush(factor);
  return count;
}

// parts[m] holds the rows younger than moments_[m] (newest first) or at least as old.
void ChangeScan::pass(const Rows& rows, bool newest_first, bool with_inputs,
                      std::vector<Part>& parts) {
  GivensQr& factor = with_inputs ? whole_ : lead_in_;
  factor.clear();
  const int first = with_inputs ? shape_.inputs * shape_.block() : 0;
  const int span = rows.span();
  int count = 0;
  const auto store_at = [&](int age) {
    const auto found = std::find(moments_.begin(), moments_.end(), age);
    if (found == moments_.end()) return;
    feed_.flush(factor);
    store(factor, first, count, parts[static_cast<std::size_t>(found - moments_.begin())]);
  };
  for (int step = 0; step < span; ++step) {
    const int age = newest_first ? step : span - 1 - step;
    if (newest_first) store_at(age);
    const double weight = rows.regression.lenient_weight(age);
    if (weight > 0.0) {
      double* row = feed_.next_row(factor);
      if (with_inputs) rows.history.fill_inputs(age, row);
      rows.regression.fill_lead_in(rows.history, age, row + first);
      row[first + shape_.lead_in()] = rows.history.residual(rows.cv, age);
      for (int c = 0; c <= first + shape_.lead_in(); ++c) row[c] *= weight;
      ++count;
    }
    if (!newest_first) store_at(age);
  }
  feed_.flush(factor);
}

void ChangeScan::store(const GivensQr& factor, int first, int rows, Part& part) const {
  const int columns = shape_.lead_in();
  part.square = factor.residual_square(0);
  part.freedom = rows - factor.columns();
  double* out = part.triangle.data();
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < columns; ++j) *out++ = j < i ? 0.0 : factor.r(first + i, first + j);
    *out++ = factor.z(first + i, 0);
  }
}

double ChangeScan::joined(const Part& a, const Part& b) {
  lead_in_.clear();
  const int columns = shape_.lead_in();
  for (const Part* part : {&a, &b}) {
    const double* from = part->triangle.data();
    for (int i = 0; i < columns; ++i, from += columns + 1)
      std::copy_n(from, columns + 1, feed_.next_row(lead_in_));
  }
  feed_.flush(lead_in_);
  return a.square + b.square + lead_in_.residual_square(0);
}

}  // namespace mpm
