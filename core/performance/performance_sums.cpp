#include "core/performance/performance_sums.hpp"

#include <algorithm>
#include <limits>

namespace mpm {

PerformanceSums::PerformanceSums(const PerformanceSetup& setup)
    : cvs(static_cast<std::size_t>(setup.counts.cv)),
      mvs(static_cast<std::size_t>(setup.counts.mv)) {
  for (CvSums& cv : cvs) cv.predictions.resize(setup.horizons.size());
}

void PerformanceSums::add(const PerformanceSums& other) {
  samples += other.samples;
  told += other.told;
  acting += other.acting;
  for (std::size_t j = 0; j < cvs.size(); ++j) {
    CvSums& cv = cvs[j];
    const CvSums& more = other.cvs[j];
    cv.known += more.known;
    cv.error.add(more.error);
    cv.outside += more.outside;
    for (std::size_t h = 0; h < cv.predictions.size(); ++h)
      cv.predictions[h].add(more.predictions[h]);
  }
  for (std::size_t i = 0; i < mvs.size(); ++i) {
    MvSums& mv = mvs[i];
    const MvSums& more = other.mvs[i];
    mv.known += more.known;
    mv.at_low += more.at_low;
    mv.at_high += more.at_high;
    mv.at_limits += more.at_limits;
    mv.standing += more.standing;
    mv.moves += more.moves;
    mv.travel += more.travel;
  }
}

void PerformanceSums::clear() {
  samples = told = acting = 0;
  for (CvSums& cv : cvs) {
    cv.known = cv.outside = 0;
    cv.error = {};
    std::fill(cv.predictions.begin(), cv.predictions.end(), PredictionSums());
  }
  std::fill(mvs.begin(), mvs.end(), MvSums());
}

double share_of(std::int64_t part, std::int64_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all)
                 : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mpm
