#include "core/mismatch/mismatch_detector.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mpm {
namespace {

namespace heavy_tails = calibration::heavy_tails;
using calibration::row_weights::kClip;
using calibration::row_weights::kLastingRows;
using calibration::row_weights::kNoiseRows;
using calibration::row_weights::kRecentRows;

// Weight of a row that waits for its own.
constexpr double kWaiting = -1.0;

}  // namespace

MismatchDetector::MismatchDetector(const RegressionShape& shape,
                                   const std::vector<MemoryLength>& memories, int remembered,
                                   int patience, const LinearModel& model,
                                   std::vector<MaterialityLimits> limits)
    : shape_(shape),
      lengths_(memories),
      remembered_(remembered),
      history_(shape, remembered),
      evaluator_(shape, model, std::move(limits)),
      evidence_(static_cast<std::size_t>(shape.inputs * shape.cvs) * memories.size()),
      rows_(shape.columns() + 1, patience),
      weighed_(shape.columns() + 1, patience),
      previews_(static_cast<std::size_t>(patience)) {
  ages_.reserve(previews_.size());
  if (memories.empty()) throw std::invalid_argument("the mismatch detector needs a memory");
  for (const MemoryLength& length : memories) {
    if (!(length.lambda > 0.0 && length.lambda <= 1.0) || length.window < 0 ||
        length.window + length.window / calibration::sliding_window::kParts > remembered)
      throw std::invalid_argument("impossible memory of the mismatch detector");
    for (int j = 0; j < shape.cvs; ++j) {
      memories_.emplace_back(shape.columns());
      slides_.push_back(0);
    }
  }
  responses_.resize(static_cast<std::size_t>(shape.cvs));
  for (Response& response : responses_) response.clipped_share = heavy_tails::kFullShare;
  for (int j = 0; j < shape.cvs; ++j) {
    weight_windows_.emplace_back(remembered);
    scale_windows_.emplace_back(remembered);
  }
}

void MismatchDetector::update(const Eigen::Ref<const Eigen::VectorXd>& inputs,
                              const Eigen::Ref<const Eigen::VectorXd>& residuals) {
  history_.push(inputs, residuals);
  for (int j = 0; j < shape_.cvs; ++j) {
    Response& response = responses_[index(j)];
    weight_windows_[index(j)].push(history_.usable(j) ? kWaiting : 0.0);
    scale_windows_[index(j)].push(response.scale);
    response.span = std::min(response.span + 1, remembered_);
    if (++response.waiting >= patience(j)) fold(j);
    for (int m = 0; m < memory_count(); ++m) slide(j, m);
  }
}

void MismatchDetector::skip(std::int64_t missing) {
  for (int j = 0; j < shape_.cvs; ++j) fold(j);
  history_.skip(missing);
  for (int j = 0; j < shape_.cvs; ++j) {
    Response& response = responses_[index(j)];
    for (std::int64_t k = 0; k < std::min(missing, static_cast<std::int64_t>(remembered_)); ++k) {
      weight_windows_[index(j)].push(0.0);
      scale_windows_[index(j)].push(response.scale);
      response.span = std::min(response.span + 1, remembered_);
    }
  }
}

int MismatchDetector::patience(int cv) const {
  return memories_[at(cv, 0)].rows >=
                 calibration::row_weights::kTogetherRowsPerColumn * shape_.columns()
             ? rows_.capacity()
             : 1;
}

void MismatchDetector::fold(int cv) {
  Response& response = responses_[index(cv)];
  if (response.waiting > 0) take(cv, std::min(response.waiting, response.span) - 1, 0);
  response.waiting = 0;
}

// The rows that wait of these ages (oldest >= newest), as many as fit into a batch.
void MismatchDetector::take(int cv, int oldest, int newest) {
  const Response& response = responses_[index(cv)];
  LagWindow& weights = weight_windows_[index(cv)];
  const int columns = shape_.columns();
  ages_.clear();
  for (int age = oldest; age >= newest; --age) {
    if (weights.window()[age] != kWaiting) continue;
    double* row = rows_.row(static_cast<int>(ages_.size()));
    history_.fill(age, row);
    row[columns] = history_.residual(cv, age);
    ages_.push_back(age);
  }
  const int count = static_cast<int>(ages_.size());
  const auto copy_weighed = [&](int k, double weight) {
    const double* from = rows_.row(k);
    double* to = weighed_.row(k);
    for (int c = 0; c <= columns; ++c) to[c] = from[c] * weight;
  };
  if (response.scaled) {
    const double before = response.scale;  // rounding noise is told by the size of what was taken
    for (int k = 0; k < count; ++k) copy_weighed(k, 1.0 / before);
    memories_[at(cv, 0)].factor.preview_batch(weighed_, count, previews_.data());
    for (int k = 0; k < count; ++k) {
      previews_[static_cast<std::size_t>(k)].error *= before;
      previews_[static_cast<std::size_t>(k)].leverage *= before * before;
    }
  }
  int k = 0;
  for (int age = oldest; age >= newest; --age) {
    scale_windows_[index(cv)].set(age, response.scale);
    if (k == count || ages_[static_cast<std::size_t>(k)] != age) continue;
    weights.set(
        age, response.scaled ? weigh(cv, previews_[static_cast<std::size_t>(k)], count > 1) : 1.0);
    ++k;
  }
  for (int m = 0; m < memory_count(); ++m) {
    const double lambda = lengths_[static_cast<std::size_t>(m)].lambda;
    for (int r = 0; r < count; ++r)
      copy_weighed(r, weights.window()[ages_[static_cast<std::size_t>(r)]]);
    memories_[at(cv, m)].update(weighed_, count, lambda);
  }
  if (!response.scaled) begin_scale(cv);
}

// Weight of the row of which this is known before it is taken; follows the noise level.
double MismatchDetector::weigh(int cv, const GivensQr::Preview& preview, bool together) {
  Response& response = responses_[index(cv)];
  double weight = 1.0 / response.scale;
  const double leverage = preview.leverage * weight * weight;
  const double error = std::abs(preview.error) * weight / std::sqrt(1.0 + leverage);  // in s.d.
  const double clipped = std::min(error, kClip);
  if (error > clipped) weight *= clipped / error;
  const bool new_direction = together && leverage > calibration::row_weights::kNewDirectionLeverage;
  response.square_rows += 1.0;
  response.clipped_share +=
      ((error > kClip && !new_direction ? 1.0 : 0.0) - response.clipped_share) /
      std::min(heavy_tails::kPriorRows + response.square_rows, kLastingRows);
  const double heavy = (response.clipped_share - heavy_tails::kFromShare) /
                       (heavy_tails::kFullShare - heavy_tails::kFromShare);
  for (int m = 0; m < memory_count(); ++m)
    memories_[at(cv, m)].heavy_tails = std::clamp(heavy, 0.0, 1.0);
  if (new_direction) return weight;
  const double square = clipped * clipped * response.scale * response.scale;
  response.recent_square +=
      (square - response.recent_square) / std::min(response.square_rows, kRecentRows);
  response.lasting_square +=
      (square - response.lasting_square) / std::min(response.square_rows, kLastingRows);
  response.scale_rows = std::min(response.scale_rows + 1.0, kNoiseRows);
  response.scale *= std::sqrt(1.0 + (clipped * clipped - 1.0) / response.scale_rows);
  return weight;
}

// The first rows come as they are; once they are twice as many as the columns they give the first
// estimate of the noise level, by which they are then divided like all that follow.
void MismatchDetector::begin_scale(int cv) {
  const RegressionMemory& first = memories_[at(cv, 0)];
  const int columns = shape_.columns();
  if (first.rows < calibration::row_weights::kFirstRowsPerColumn * columns) return;
  const double freedom = first.freedom();
  const double mean_square = first.factor.residual_square(0) / first.weight_sum *
                             (freedom + columns) / std::max(freedom, 1.0);
  if (!(mean_square > 0.0)) return;
  Response& response = responses_[index(cv)];
  response.scale = std::sqrt(mean_square);
  response.scale_rows = std::min(std::max(freedom, 1.0), kNoiseRows);
  response.scaled = true;
  for (int m = 0; m < memory_count(); ++m) memories_[at(cv, m)].factor.scale(1.0 / response.scale);
  for (int age = 0; age < response.span; ++age) {
    const bool took = weight_windows_[index(cv)].window()[age] > 0.0;
    weight_windows_[index(cv)].set(age, took ? 1.0 / response.scale : 0.0);
    scale_windows_[index(cv)].set(age, response.scale);
  }
}

// The window is rebuilt now and then: never a row is taken out of a factor, which would lose digits
// after an outlier.
void MismatchDetector::slide(int cv, int memory) {
  const int window = lengths_[static_cast<std::size_t>(memory)].window;
  if (window == 0 || responses_[index(cv)].span <= window) return;
  if (++slides_[at(cv, memory)] < window / calibration::sliding_window::kParts) return;
  slides_[at(cv, memory)] = 0;
  fold(cv);
  refill(cv, memory, window);
}

// From the rows as they were weighed.
void MismatchDetector::refill(int cv, int memory, int samples) {
  RegressionMemory& target = memories_[at(cv, memory)];
  const double lambda = lengths_[static_cast<std::size_t>(memory)].lambda;
  target.clear();
  const int columns = shape_.columns();
  int count = 0;
  for (int age = samples - 1; age >= 0; --age) {
    const double weight = row_weight(cv, age);
    if (weight > 0.0) {
      double* row = weighed_.row(count++);
      history_.fill(age, row);
      row[columns] = history_.residual(cv, age);
      for (int c = 0; c <= columns; ++c) row[c] *= weight;
    }
    if (count < weighed_.capacity() && age > 0) continue;
    target.update(weighed_, count, lambda);
    count = 0;
  }
}

// Rows are weighed anew: what was surprising under what is now forgotten may be usual after it.
void MismatchDetector::start_afresh(int cv, int samples) {
  fold(cv);
  Response& response = responses_[index(cv)];
  response.span = std::min(samples, response.span);
  for (int m = 0; m < memory_count(); ++m) {
    memories_[at(cv, m)].clear();
    slides_[at(cv, m)] = 0;
  }
  if (response.span == 0) return;
  response.scale = scale_windows_[index(cv)].window()[response.span - 1];
  response.square_rows = response.recent_square = response.lasting_square = 0.0;
  response.clipped_share = heavy_tails::kFromShare;
  for (int age = response.span - 1; age >= 0; --age)
    if (row_weight(cv, age) > 0.0) weight_windows_[index(cv)].set(age, kWaiting);
  for (int oldest = response.span - 1; oldest >= 0;) {
    const int newest = std::max(oldest - patience(cv) + 1, 0);
    take(cv, oldest, newest);
    oldest = newest - 1;
  }
}

void MismatchDetector::evaluate(int cv, int memory) {
  fold(cv);
  evaluator_.evaluate(cv, memories_[at(cv, memory)],
                      &evidence_[at(cv, memory) * static_cast<std::size_t>(shape_.inputs)]);
}

}  // namespace mpm
