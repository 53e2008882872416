#include "core/mismatch/residual_regression.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/archive/archive.hpp"

namespace mpm {
namespace {

// Weight of a row that waits for its own.
constexpr double kWaiting = -1.0;

}  // namespace

RowWorkspace::RowWorkspace(int columns, int capacity)
    : rows(columns + 1, capacity),
      weighed(columns + 1, capacity),
      previews(static_cast<std::size_t>(capacity)) {
  ages.reserve(previews.size());
}

ResidualRegression::ResidualRegression(const RegressionShape& shape, int cv,
                                       const std::vector<MemoryLength>& lengths, int remembered)
    : cv_(cv),
      shape_(shape),
      columns_(shape.columns()),
      remembered_(remembered),
      weights_(remembered),
      scales_(remembered),
      slides_(lengths.size(), 0) {
  if (lengths.empty()) throw std::invalid_argument("the mismatch detector needs a memory");
  for (const MemoryLength& length : lengths) {
    if (!(length.lambda > 0.0 && length.lambda <= 1.0) || length.window < 0 ||
        length.window + length.window / calibration::sliding_window::kParts > remembered)
      throw std::invalid_argument("impossible memory of the mismatch detector");
    memories_.emplace_back(columns_, length);
  }
  reserve_first_rows();
}

void ResidualRegression::take_in(VolterraTerms terms, const RegressionHistory& history,
                                 RowWorkspace& work) {
  fold(history, work);
  make_room(terms);
  terms_ = std::move(terms);
  start_afresh(span_, history, work);
}

void ResidualRegression::make_room(const VolterraTerms& terms) {
  columns_ += terms.columns() - (terms_ ? terms_->columns() : 0);
  for (RegressionMemory& memory : memories_) memory = RegressionMemory(columns_, memory.length);
  reserve_first_rows();
}

void ResidualRegression::archive(Archive& a, const LinearModel& model,
                                 const RegressionHistory& history, const RowWorkspace& work) {
  // not archived: cv_, shape_, remembered_ (construction)
  // not archived: columns_ (of the terms' inputs)
  // not archived: left_, sorted_ (empty between calls)
  bool has_terms = terms_.has_value();
  a(has_terms);
  if (has_terms) {
    std::vector<int> inputs = terms_ ? terms_->inputs() : std::vector<int>{};
    a.varying(inputs);
    a.require(VolterraTerms::possible(inputs, model), "terms that no CV has");
    if (a.reads()) {
      VolterraTerms terms(model, cv_, std::move(inputs), history.depth());
      make_room(terms);
      terms_ = std::move(terms);
    }
    a(*terms_);
  }
  a.within(span_, 0, remembered_);
  a.within(waiting_, 0, work.rows.capacity() - 1);
  a(restarts_, settled_, noise_, weights_, scales_, memories_, slides_);
}

void ResidualRegression::add_sample(const RegressionHistory& history, RowWorkspace& work) {
  if (terms_) terms_->push(history);
  weights_.push(history.usable(cv_) ? kWaiting : 0.0);
  scales_.push(noise_.scale());
  span_ = std::min(span_ + 1, remembered_);
  if (++waiting_ >= patience(work)) fold(history, work);
  for (std::size_t m = 0; m < memories_.size(); ++m) slide(m, history, work);
}

void ResidualRegression::add_gap(std::int64_t missing) {
  for (std::int64_t k = 0; k < std::min(missing, static_cast<std::int64_t>(remembered_)); ++k) {
    weights_.push(0.0);
    scales_.push(noise_.scale());
    span_ = std::min(span_ + 1, remembered_);
  }
}

void ResidualRegression::follow_gap(std::int64_t missing, const RegressionHistory& history) {
  if (!terms_) return;
  for (std::int64_t k = 0; k < std::min(missing, static_cast<std::int64_t>(remembered_)); ++k)
    terms_->push(history);
}

int ResidualRegression::patience(const RowWorkspace& work) const {
  const int together = calibration::row_weights::kTogetherRowsPerColumn * columns_;
  return memories_.front().rows >= together ? work.rows.capacity() : 1;
}

void ResidualRegression::fold(const RegressionHistory& history, RowWorkspace& work) {
  if (waiting_ > 0) take(std::min(waiting_, span_) - 1, 0, history, work);
  waiting_ = 0;
}

// The rows that wait of these ages (oldest >= newest), as many as fit into a batch.
void ResidualRegression::take(int oldest, int newest, const RegressionHistory& history,
                              RowWorkspace& work) {
  gather(oldest, newest, history, work);
  if (noise_.known() && settled_) preview(work);
  weigh(oldest, newest, work);
  const int count = static_cast<int>(work.ages.size());
  for (RegressionMemory& memory : memories_) {
    for (int k = 0; k < count; ++k)
      copy_weighed(k, row_weight(work.ages[static_cast<std::size_t>(k)]), work);
    memory.take(work.weighed, count);
  }
  if (!noise_.known()) begin_noise();
  if (!settled_) settle(newest, history, work);
}

void ResidualRegression::gather(int oldest, int newest, const RegressionHistory& history,
                                RowWorkspace& work) const {
  work.ages.clear();
  for (int age = oldest; age >= newest; --age) {
    if (row_weight(age) != kWaiting) continue;
    double* row = work.rows.row(static_cast<int>(work.ages.size()));
    fill(history, age, row);
    row[columns_] = history.residual(cv_, age);
    work.ages.push_back(age);
  }
}

// In units of the noise level: rounding noise is told by the size of what was taken.
void ResidualRegression::preview(RowWorkspace& work) const {
  const int count = static_cast<int>(work.ages.size());
  const double scale = noise_.scale();
  for (int k = 0; k < count; ++k) copy_weighed(k, 1.0 / scale, work);
  memories_.front().factor.preview_batch(work.weighed, count, work.previews.data());
  for (int k = 0; k < count; ++k) {
    GivensQr::Preview& preview = work.previews[static_cast<std::size_t>(k)];
    preview.error *= scale;
    preview.leverage *= scale * scale;
  }
}

void ResidualRegression::weigh(int oldest, int newest, const RowWorkspace& work) {
  const std::size_t count = work.ages.size();
  std::size_t k = 0;
  for (int age = oldest; age >= newest; --age) {
    scales_.set(age, noise_.scale());
    if (k == count || work.ages[k] != age) continue;
    if (!noise_.known())
      weights_.set(age, 1.0);
    else
      weights_.set(age,
                   settled_ ? noise_.weigh(work.previews[k], count > 1) : 1.0 / noise_.scale());
    ++k;
  }
  if (!noise_.known() || count == 0) return;
  for (RegressionMemory& memory : memories_) memory.follow_tails(noise_.heavy_tails());
}

void ResidualRegression::copy_weighed(int k, double weight, RowWorkspace& work) const {
  const double* from = work.rows.row(k);
  double* to = work.weighed.row(k);
  for (int c = 0; c <= columns_; ++c) to[c] = from[c] * weight;
}

// The first rows come as they are; once they are twice as many as the columns they give the first
// estimate of the noise level, by which they are then divided like all that follow.
void ResidualRegression::begin_noise() {
  const RegressionMemory& first = memories_.front();
  if (first.rows < calibration::row_weights::kFirstRowsPerColumn * columns_) return;
  const double freedom = first.freedom();
  const double mean_square = first.factor.residual_square(0) / first.weight_sum *
                             (freedom + columns_) / std::max(freedom, 1.0);
  if (!(mean_square > 0.0)) return;
  noise_.begin(mean_square, freedom);
  const double weight = 1.0 / noise_.scale();
  for (RegressionMemory& memory : memories_) memory.factor.scale(weight);
  for (int age = 0; age < span_; ++age) {
    weights_.set(age, row_weight(age) > 0.0 ? weight : 0.0);
    scales_.set(age, noise_.scale());
  }
}

void ResidualRegression::reserve_first_rows() {
  const auto rows =
      static_cast<std::size_t>(calibration::row_weights::kFirstRowsPerColumn * columns_);
  left_.reserve(rows);
  sorted_.reserve(rows);
}

// Some of the first rows after a fresh start may be of before the change that it is for, and while
// rows are hardly more than columns each of them spoils the predictions of all that follow. So the
// first ones are weighed together once they are enough, by what the fit leaves of each, in turns
// (iteratively reweighted least squares: Holland and Welsch 1977).
void ResidualRegression::settle(int newest, const RegressionHistory& history, RowWorkspace& work) {
  if (memories_.front().rows < calibration::row_weights::kFirstRowsPerColumn * columns_) return;
  settled_ = true;
  for (int turn = 0; turn < calibration::row_weights::kSettlingTurns; ++turn) {
    const double scale = spread(newest, history, work);
    if (!(scale > calibration::kRounding * noise_.scale())) break;  // a simulation without noise
    noise_.restart(scale);
    std::size_t k = 0;
    for (int age = span_ - 1; age >= newest; --age)
      if (row_weight(age) > 0.0) weights_.set(age, noise_.weigh(left_[k++] / scale));
    for (RegressionMemory& memory : memories_) {
      const int window = memory.length.window;
      refill(memory, window > 0 ? std::min(window, span_) : span_, history, work);
    }
  }
  for (int age = span_ - 1; age >= newest; --age) scales_.set(age, noise_.scale());
  for (RegressionMemory& memory : memories_) memory.follow_tails(noise_.heavy_tails());
}

// Into `left_` what the fit leaves of each row, in CV units, its leverage taken out; their s.d. by
// the median of their magnitudes, which half of the rows cannot spoil.
double ResidualRegression::spread(int newest, const RegressionHistory& history,
                                  RowWorkspace& work) {
  left_.clear();
  for (int age = span_ - 1; age >= newest; --age) {
    const double weight = row_weight(age);
    if (!(weight > 0.0)) continue;
    double* row = work.weighed.row(0);
    fill(history, age, row);
    row[columns_] = history.residual(cv_, age);
    for (int c = 0; c <= columns_; ++c) row[c] *= weight;
    memories_.front().factor.preview_batch(work.weighed, 1, work.previews.data());
    const double share =
        std::max(calibration::row_weights::kLeastLeft, 1.0 - work.previews[0].leverage);
    left_.push_back(std::abs(work.previews[0].error) / weight / std::sqrt(share));
  }
  if (left_.empty()) return 0.0;
  sorted_ = left_;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return *middle / calibration::row_weights::kMedianMagnitude;
}

// The window is rebuilt now and then: never a row is taken out of a factor, which would lose digits
// after an outlier.
void ResidualRegression::slide(std::size_t index, const RegressionHistory& history,
                               RowWorkspace& work) {
  const int window = memories_[index].length.window;
  if (window == 0 || span_ <= window) return;
  if (++slides_[index] < window / calibration::sliding_window::kParts) return;
  slides_[index] = 0;
  fold(history, work);
  refill(memories_[index], window, history, work);
}

// From the rows as they were weighed.
void ResidualRegression::refill(RegressionMemory& memory, int samples,
                                const RegressionHistory& history, RowWorkspace& work) const {
  memory.clear();
  int count = 0;
  for (int age = samples - 1; age >= 0; --age) {
    const double weight = row_weight(age);
    if (weight > 0.0) {
      double* row = work.weighed.row(count++);
      fill(history, age, row);
      row[columns_] = history.residual(cv_, age);
      for (int c = 0; c <= columns_; ++c) row[c] *= weight;
    }
    if (count < work.weighed.capacity() && age > 0) continue;
    memory.take(work.weighed, count);
    count = 0;
  }
}

void ResidualRegression::start_afresh(int samples, const RegressionHistory& history,
                                      RowWorkspace& work) {
  fold(history, work);
  ++restarts_;
  span_ = std::min(samples, span_);
  for (RegressionMemory& memory : memories_) memory.clear();
  std::fill(slides_.begin(), slides_.end(), 0);
  settled_ = !noise_.known();
  if (span_ == 0) return;
  noise_.restart(scales_.window()[span_ - 1]);
  for (int age = span_ - 1; age >= 0; --age)
    if (row_weight(age) > 0.0) weights_.set(age, kWaiting);
  for (int oldest = span_ - 1; oldest >= 0;) {
    const int newest = std::max(oldest - patience(work) + 1, 0);
    take(oldest, newest, history, work);
    oldest = newest - 1;
  }
}

}  // namespace mpm
