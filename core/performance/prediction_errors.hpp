#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/monitor/cv_reading.hpp"

namespace mpm {

/// Errors of predictions over one horizon, summed; NaN where there is none.
struct PredictionSums {
  std::int64_t pairs = 0;
  double error_square = 0.0, movement_square = 0.0;  ///< CV units squared

  void add(const PredictionSums& other);
  /// Root mean square of the errors, CV units.
  [[nodiscard]] double rmse() const;
  /// Of what the measurement itself did meanwhile: the error of who predicts no change.
  [[nodiscard]] double movement_rms() const;

  template <class Archive>
  void archive(Archive& a) {
    a(pairs, error_square, movement_square);
  }
};

/// How well CVs were predicted over some horizons, with the usual output-bias update: the error of
/// a prediction made h samples ago is e(k) - e(k-h), e = measured - predicted (Shook, Mohtadi and
/// Shah 1992 judge models so). Remembers as many readings as the longest horizon has samples. No
/// allocation after construction.
class PredictionErrors {
 public:
  /// `horizons` in samples, >= 1.
  PredictionErrors(int cvs, std::vector<std::int64_t> horizons);

  /// The readings of one interval, a later one each time; those between are not known. Calls
  /// sums(cv, index of the horizon), a PredictionSums&, for each pair that is known.
  template <class Sums>
  void push(std::int64_t interval, std::span<const CvReading> readings, Sums sums);
  /// As after construction: what follows is another run.
  void forget();

  template <class Archive>
  void archive(Archive& a) {
    // not archived: cvs_, rows_, horizons_ (construction)
    a.within(place_, 0, rows_ - 1);
    a(ring_, interval_, begun_);
  }

 private:
  void skip_to(std::int64_t interval);
  void remember(std::span<const CvReading> readings);
  [[nodiscard]] const CvReading& ago(std::int64_t samples, std::size_t cv) const {
    const auto back = static_cast<std::size_t>(samples);
    return ring_[((place_ + rows_ - back) % rows_) * cvs_ + cv];
  }

  std::size_t cvs_, rows_;
  std::vector<std::int64_t> horizons_;
  std::vector<CvReading> ring_;  // rows x CVs
  std::size_t place_ = 0;        // row of the next
  std::int64_t interval_ = 0;    // of the last
  bool begun_ = false;
};

template <class Sums>
void PredictionErrors::push(std::int64_t interval, std::span<const CvReading> readings, Sums sums) {
  skip_to(interval);
  for (std::size_t cv = 0; cv < cvs_; ++cv) {
    const CvReading& now = readings[cv];
    if (now.residual != now.residual) continue;  // NaN
    for (std::size_t h = 0; h < horizons_.size(); ++h) {
      const CvReading& before = ago(horizons_[h], cv);
      if (before.residual != before.residual) continue;
      const double error = now.residual - before.residual;
      const double movement = now.measured - before.measured;
      sums(cv, h).add({1, error * error, movement * movement});
    }
  }
  remember(readings);
}

}  // namespace mpm
