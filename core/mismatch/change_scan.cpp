#include "core/mismatch/change_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics/f_distribution.hpp"

namespace mpm {
namespace {

using calibration::change_scan::kMargin;
using calibration::change_scan::kMoments;

// Rows that a factor takes together: speed only.
constexpr int kBatchRows = 32;

}  // namespace

ChangeScan::ChangeScan(const RegressionShape& shape)
    : shape_(shape),
      batch_(shape.columns() + 1, kBatchRows),
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

std::optional<ChangePoint> ChangeScan::scan(const MismatchDetector& detector, int cv) {
  const int span = detector.span(cv);
  if (span < 2 * kMoments) return std::nullopt;
  moments_.clear();  // ages at which a part ends, newest first
  for (int m = 1; m < kMoments; ++m) moments_.push_back(m * span / kMoments);
  pass(detector, cv, true, true, after_with_);
  pass(detector, cv, true, false, after_without_);
  pass(detector, cv, false, true, before_with_);
  const double constant = whole_.residual_square(0);
  const double freedom = detector.memory(cv).rows - shape_.columns();
  pass(detector, cv, false, false, before_without_);
  if (!(constant > 0.0) || freedom <= 0.0) return std::nullopt;

  const double inputs = shape_.inputs * shape_.block();
  const double chance =
      inputs + calibration::change_scan::kChanceDeviations * std::sqrt(2.0 * inputs);
  const double per_square = freedom / constant;
  // The gain, where it can exceed `least` at all: joining the parts only leaves more.
  const auto gain_of = [&](const Part& after, const Part& before, double least) {
    // Where one side is noisier than all rows together, so is what it gains by chance.
    const double noise =
        std::max({1.0, variance_of(after) * per_square, variance_of(before) * per_square});
    const double scale = per_square / noise;
    if ((constant - after.square - before.square) * scale <= least) return least;
    return (constant - joined(after, before)) * scale;
  };
  ChangePoint best{ChangeKind::kBegan, 0, kMargin};
  ChangePoint end{ChangeKind::kEnded, 0, kMargin};
  for (std::size_t m = 0; m < moments_.size(); ++m) {
    const double began = gain_of(after_with_[m], before_without_[m], best.gain);
    if (began > best.gain) best = {ChangeKind::kBegan, moments_[m], began};
    const double ended = gain_of(after_without_[m], before_with_[m], end.gain);
    if (ended > end.gain) end = {ChangeKind::kEnded, moments_[m], ended};
  }
  if (end.gain > best.gain) best = end;
  double bar = best.gain + chance;
  for (std::size_t m = 0; m < moments_.size(); ++m) {
    if (moments_[m] < calibration::change_scan::kRowsPerColumn * shape_.columns()) continue;
    const double other = gain_of(after_with_[m], before_with_[m], bar);
    if (other <= bar) continue;
    best = {ChangeKind::kOther, moments_[m], other};
    bar = other;
  }
  if (best.samples == 0) return std::nullopt;
  if (best.kind != ChangeKind::kEnded) name_input(detector, cv, best);
  // The rows between the change and the nearest moment looked at fit neither side of an end; twice
  // as many parameters hide them, and then find nothing in all that came since.
  const bool over = best.kind == ChangeKind::kOther && end.samples > 0 &&
                    best.p_value > calibration::change_scan::kNothingPValue;
  return over ? end : best;
}

// The input that alone explains the rows since the change best, and its F on these rows alone: with
// rows clipped as leniently as above and as strictly as in the detector, the larger p. A burst of
// noise passes the first, hardly both.
void ChangeScan::name_input(const MismatchDetector& detector, int cv, ChangePoint& change) {
  const InputFit lenient = best_input(detector, cv, change.samples, false);
  const InputFit strict = best_input(detector, cv, change.samples, true);
  change.input = lenient.input;
  change.p_value = std::max(lenient.p_value, strict.p_value);
}

ChangeScan::InputFit ChangeScan::best_input(const MismatchDetector& detector, int cv, int samples,
                                            bool strict) {
  const int block = shape_.block();
  const RegressionHistory& history = detector.history();
  double least = std::numeric_limits<double>::infinity();
  double nothing = 0.0;
  int rows = 0;
  InputFit best;
  for (int input = -1; input < shape_.inputs; ++input) {
    GivensQr& factor = input < 0 ? lead_in_ : one_input_;
    factor.clear();
    rows = 0;
    for (int age = samples - 1; age >= 0; --age) {
      const double weight =
          strict ? detector.row_weight(cv, age) : detector.lenient_weight(cv, age);
      if (!(weight > 0.0)) continue;
      double* row = next_row(factor);
      history.fill_lead_in(age, row);
      if (input >= 0) {
        history.fill_inputs(age, inputs_.data());
        std::copy_n(inputs_.data() + input * block, block, row + shape_.lead_in());
      }
      row[factor.columns()] = history.residual(cv, age);
      for (int c = 0; c <= factor.columns(); ++c) row[c] *= weight;
      ++rows;
    }
    flush(factor);
    if (input < 0) nothing = factor.residual_square(0);
    if (input < 0 || factor.residual_square(0) >= least) continue;
    least = factor.residual_square(0);
    best.input = input;
  }
  const int freedom = rows - shape_.lead_in() - block;
  if (freedom < calibration::change_scan::kFewestFreedom || !(least > 0.0)) return best;
  const double statistic = (nothing - least) / block / (least / freedom);
  best.p_value = std::min(1.0, shape_.inputs * f_upper_tail(statistic, block, freedom));
  return best;
}

// parts[m] holds the rows younger than moments_[m] (newest first) or at least as old.
void ChangeScan::pass(const MismatchDetector& detector, int cv, bool newest_first, bool with_inputs,
                      std::vector<Part>& parts) {
  GivensQr& factor = with_inputs ? whole_ : lead_in_;
  factor.clear();
  const RegressionHistory& history = detector.history();
  const int first = with_inputs ? shape_.inputs * shape_.block() : 0;
  const int span = detector.span(cv);
  int rows = 0;
  const auto store_at = [&](int age) {
    const auto found = std::find(moments_.begin(), moments_.end(), age);
    if (found == moments_.end()) return;
    flush(factor);
    store(factor, first, rows, parts[static_cast<std::size_t>(found - moments_.begin())]);
  };
  for (int step = 0; step < span; ++step) {
    const int age = newest_first ? step : span - 1 - step;
    if (newest_first) store_at(age);
    const double weight = detector.lenient_weight(cv, age);
    if (weight > 0.0) {
      double* row = next_row(factor);
      if (with_inputs) history.fill_inputs(age, row);
      history.fill_lead_in(age, row + first);
      row[first + shape_.lead_in()] = history.residual(cv, age);
      for (int c = 0; c <= first + shape_.lead_in(); ++c) row[c] *= weight;
      ++rows;
    }
    if (!newest_first) store_at(age);
  }
  flush(factor);
}

double* ChangeScan::next_row(GivensQr& factor) {
  if (waiting_ == kBatchRows) flush(factor);
  return batch_.row(waiting_++);
}

void ChangeScan::flush(GivensQr& factor) {
  if (waiting_ > 0) factor.update_batch(batch_, waiting_, 1.0);
  waiting_ = 0;
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
      std::copy_n(from, columns + 1, next_row(lead_in_));
  }
  flush(lead_in_);
  return a.square + b.square + lead_in_.residual_square(0);
}

}  // namespace mpm
