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
  shares.reserve(previews.size());
}

ResidualRegression::ResidualRegression(const RegressionShape& shape, int cv,
                                       const std::vector<MemoryLength>& lengths, int remembered)
    : cv_(cv),
      shape_(shape),
      columns_(shape.columns()),
      remembered_(remembered),
      noise_(shape.bounded),
      weights_(remembered),
      shares_(remembered),
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
  make_room(shape_.columns() + terms.columns());
  terms_ = std::move(terms);
  start_afresh(span_, history, work);
}

void ResidualRegression::leave_out_terms() {
  terms_.reset();
  make_room(shape_.columns());
}

void ResidualRegression::make_room(int columns) {
  columns_ = columns;
  for (RegressionMemory& memory : memories_) memory = RegressionMemory(columns_, memory.length);
  reserve_first_rows();
}

void ResidualRegression::archive(Archive& a, const LinearModel& model,
                                 const RegressionHistory& history, const RowWorkspace& work) {
  // not archived: cv_, shape_, remembered_ (construction)
  // not archived: columns_ (of the terms' inputs)
  // not archived: first_, sorted_ (empty between calls)
  bool has_terms = terms_.has_value();
  a(has_terms);
  if (has_terms) {
    std::vector<int> inputs = terms_ ? terms_->inputs() : std::vector<int>{};
    a.varying(inputs);
    a.require(VolterraTerms::possible(inputs, model), "terms that no CV has");
    if (a.reads()) {
      VolterraTerms terms(model, cv_, std::move(inputs), history.depth());
      make_room(shape_.columns() + terms.columns());
      terms_ = std::move(terms);
    }
    a(*terms_);
  }
  a.within(span_, 0, remembered_);
  a.within(waiting_, 0, work.rows.capacity() - 1);
  a(restarts_, settled_, noise_, weights_, shares_, scales_, memories_, slides_);
}

void ResidualRegression::add_sample(const RegressionHistory& history, RowWorkspace& work) {
  if (terms_) terms_->push(history);
  weights_.push(history.usable(cv_) ? kWaiting : 0.0);
  shares_.push(1.0);
  scales_.push(noise_.scale());
  span_ = std::min(span_ + 1, remembered_);
  if (++waiting_ >= patience(work)) fold(history, work);
  for (std::size_t m = 0; m < memories_.size(); ++m) slide(m, history, work);
}

void ResidualRegression::add_gap(std::int64_t missing) {
  for (std::int64_t k = 0; k < std::min(missing, static_cast<std::int64_t>(remembered_)); ++k) {
    weights_.push(0.0);
    shares_.push(1.0);
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
  if (settled_) preview(work);
  weigh(oldest, newest, work);
  for (RegressionMemory& memory : memories_) {
    for (std::size_t k = 0; k < work.ages.size(); ++k)
      weigh_copy(k, row_weight(work.ages[k]), work);
    take_weighed(memory, work);
  }
  if (!settled_) settle(newest, history, work);
}

void ResidualRegression::take_weighed(RegressionMemory& memory, RowWorkspace& work) const {
  work.shares.clear();
  for (const int age : work.ages) work.shares.push_back(row_share(age));
  memory.take(work.weighed, work.shares.data(), static_cast<int>(work.ages.size()));
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
  for (std::size_t k = 0; k < work.ages.size(); ++k) weigh_copy(k, 1.0 / scale, work);
  memories_.front().factor.preview_batch(work.weighed, count, work.previews.data());
  for (std::size_t k = 0; k < work.ages.size(); ++k) {
    work.previews[k].error *= scale;
    work.previews[k].leverage *= scale * scale;
  }
}

void ResidualRegression::weigh(int oldest, int newest, const RowWorkspace& work) {
  const std::size_t count = work.ages.size();
  std::size_t k = 0;
  for (int age = oldest; age >= newest; --age) {
    scales_.set(age, noise_.scale());
    if (k == count || work.ages[k] != age) continue;
    weigh_row(age, settled_ ? noise_.weigh(work.previews[k], count > 1)
                            : RowWeight{1.0 / noise_.scale(), 1.0});
    ++k;
  }
}

void ResidualRegression::weigh_row(int age, const RowWeight& weight) {
  weights_.set(age, weight.weight);
  shares_.set(age, weight.share);
}

// The k-th row as it is, into its place among the weighed ones.
void ResidualRegression::weigh_copy(std::size_t k, double weight, RowWorkspace& work) const {
  const double* from = work.rows.row(static_cast<int>(k));
  double* to = work.weighed.row(static_cast<int>(k));
  for (int c = 0; c <= columns_; ++c) to[c] = from[c] * weight;
}

// The row of that age, as it was weighed, behind those of `work`.
void ResidualRegression::copy_weighed(int age, const RegressionHistory& history,
                                      RowWorkspace& work) const {
  double* row = work.weighed.row(static_cast<int>(work.ages.size()));
  fill(history, age, row);
  row[columns_] = history.residual(cv_, age);
  for (int c = 0; c <= columns_; ++c) row[c] *= row_weight(age);
  work.ages.push_back(age);
}

bool ResidualRegression::full(const RowWorkspace& work) {
  return static_cast<int>(work.ages.size()) == work.weighed.capacity();
}

// The very first rows come as they are; they give the first estimate of the noise level, by which
// they are then divided like all that follow.
void ResidualRegression::begin_noise() {
  const RegressionMemory& first = memories_.front();
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
  const auto rows = static_cast<std::size_t>(first_rows());
  first_.reserve(rows);
  sorted_.reserve(rows);
}

// Some of the first rows may be wild, or of before the change that a fresh start is for, and while
// rows are hardly more than columns each of them spoils the predictions of all that follow. So the
// first ones are weighed together once they are enough, by what the fit leaves of each, in turns
// (iteratively reweighted least squares: Holland and Welsch 1977). A unit's CVs do so one after the
// other, sample by sample: with 20 of them and 600 columns all at once take seconds.
void ResidualRegression::settle(int newest, const RegressionHistory& history, RowWorkspace& work) {
  if (memories_.front().rows < first_rows()) return;
  if (!noise_.known()) begin_noise();
  if (!noise_.known()) return;
  settled_ = true;
  for (int turn = 0; turn < calibration::row_weights::kSettlingTurns; ++turn) {
    const double scale = spread(newest, history, work);
    if (!(scale > calibration::kRounding * noise_.scale())) break;  // a simulation without noise
    noise_.restart(scale, turn == 0 ? calibration::heavy_tails::kFullShare : clipped_share(scale));
    std::size_t k = 0;
    for (int age = span_ - 1; age >= newest; --age)
      if (row_weight(age) > 0.0) {
        const FirstRow& row = first_[k++];
        weigh_row(age, noise_.weigh(row.error / scale, row.leverage));
      }
    for (RegressionMemory& memory : memories_) {
      const int window = memory.length.window;
      refill(memory, window > 0 ? std::min(window, span_) : span_, history, work);
    }
  }
  for (int age = span_ - 1; age >= newest; --age) scales_.set(age, noise_.scale());
}

// Of so few rows one or two beyond the clip are no sign of heavy tails.
double ResidualRegression::clipped_share(double scale) const {
  double clipped = 0.0, rows = calibration::heavy_tails::kPriorRows;
  for (const FirstRow& row : first_) {
    if (!NoiseLevel::tells_of_tails(row.leverage)) continue;
    if (row.error > calibration::row_weights::kClip * scale) clipped += 1.0;
    rows += 1.0;
  }
  return clipped / rows;
}

// Into `first_` what the fit leaves of each row; the errors' s.d. by the median of their
// magnitudes, which half of the rows cannot spoil.
double ResidualRegression::spread(int newest, const RegressionHistory& history,
                                  RowWorkspace& work) {
  first_.clear();
  sorted_.clear();
  for (int oldest = span_ - 1; oldest >= newest;) {
    work.ages.clear();
    for (; oldest >= newest && !full(work); --oldest)
      if (row_weight(oldest) > 0.0) copy_weighed(oldest, history, work);
    memories_.front().factor.preview_batch(work.weighed, static_cast<int>(work.ages.size()),
                                           work.previews.data());
    for (std::size_t k = 0; k < work.ages.size(); ++k) {
      first_.push_back(first_row(work.ages[k], work.previews[k]));
      sorted_.push_back(first_.back().error);
    }
  }
  if (sorted_.empty()) return 0.0;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return *middle / calibration::row_weights::kMedianMagnitude;
}

// Of a row that counts for part of one the error is larger than it takes itself for.
ResidualRegression::FirstRow ResidualRegression::first_row(int age,
                                                           const GivensQr::Preview& left) const {
  const auto at_least = [](double part) {
    return std::max(calibration::row_weights::kLeastLeft, part);
  };
  const double share = row_share(age);
  const double variance = at_least(1.0 + left.leverage / share - 2.0 * left.leverage);
  return {std::abs(left.error) / row_weight(age) / std::sqrt(variance),
          left.leverage / at_least(1.0 - left.leverage) / share};
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
  for (int oldest = samples - 1; oldest >= 0;) {
    work.ages.clear();
    for (; oldest >= 0 && !full(work); --oldest)
      if (row_weight(oldest) > 0.0) copy_weighed(oldest, history, work);
    take_weighed(memory, work);
  }
}

void ResidualRegression::start_afresh(int samples, const RegressionHistory& history,
                                      RowWorkspace& work) {
  fold(history, work);
  ++restarts_;
  span_ = std::min(samples, span_);
  for (RegressionMemory& memory : memories_) memory.clear();
  std::fill(slides_.begin(), slides_.end(), 0);
  settled_ = false;
  if (span_ == 0) return;
  noise_.restart(scales_.window()[span_ - 1], calibration::heavy_tails::kFromShare);
  for (int age = span_ - 1; age >= 0; --age)
    if (row_weight(age) > 0.0) weights_.set(age, kWaiting);
  for (int oldest = span_ - 1; oldest >= 0;) {
    const int newest = std::max(oldest - patience(work) + 1, 0);
    take(oldest, newest, history, work);
    oldest = newest - 1;
  }
}

}  // namespace mpm
