#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

namespace mpm::hidden {

/// v(k) = pole v(k-1) + e(k) + moving e(k-1) on one CV, from long ago.
struct CvNoise {
  double sigma = 0.0;  ///< s.d. of e
  double pole = 0.95;
  double moving = 0.0;
  double freedom = 0.0;         ///< e is Student's t scaled to `sigma`; 0 = normal
  double variance_ratio = 1.0;  ///< of e from `onset` on
  int onset = std::numeric_limits<int>::max();

  /// S.d. of v before the onset.
  [[nodiscard]] double deviation() const;
};

/// samples x CVs.
[[nodiscard]] Eigen::MatrixXd draw_noise(const std::vector<CvNoise>& cvs, Eigen::Index samples,
                                         std::uint64_t seed);

/// What `noise` would have needed as e to make `signal`, in units of sigma: its sum of squares is
/// 2 ln of the odds that whoever knows all but the signal's presence gets for it, on average.
[[nodiscard]] Eigen::VectorXd whitened(const CvNoise& noise, const Eigen::VectorXd& signal);

/// The same odds for somebody who must also find the CV's level, and how much there is of each of
/// the other signals: what of `signal` none of these can stand for.
[[nodiscard]] double evidence(const CvNoise& noise, const Eigen::VectorXd& signal,
                              const std::vector<Eigen::VectorXd>& others = {});

}  // namespace mpm::hidden
