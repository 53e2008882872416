#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identify/fit/problem.hpp"

namespace mpm {

/// A quick look at many candidates: one Gauss-Newton step from each one's start, the noise models
/// and everything accepted so far held as they are. Ranks; decides nothing.
class Screening {
 public:
  /// `without`: the fit of each CV without any candidate.
  Screening(Problem& problem, const std::vector<Effect>& accepted,
            const std::vector<CvFit>& without);

  /// About 2 ln of the odds for the candidate, search cost taken off. Any number of threads may ask
  /// at once.
  [[nodiscard]] double score(const Effect& candidate) const;

 private:
  struct Cv {
    const CvFit* fit;
    WhitenedRows whiten;
    Eigen::VectorXd simulated;
    Eigen::MatrixXd basis;     ///< orthonormal, of the whitened nuisances beside their prior
    Eigen::VectorXd residual;  ///< whitened
  };

  Problem& problem_;
  std::vector<Effect> accepted_;
  std::vector<Cv> cvs_;
};

}  // namespace mpm
