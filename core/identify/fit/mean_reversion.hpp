#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace mpm {

/// Whether a signal (any unit, NaN where unknown) comes back to one level: the augmented
/// Dickey-Fuller test (Said and Dickey 1984) with a constant rejects, at 5 %, that it wanders like
/// a random walk. Asked of the means of some hundred blocks, so that noise on top, which would hide
/// the walk, averages out. Of what wanders no level can be told; false too where there are too few
/// rows to say.
[[nodiscard]] bool comes_back(const Eigen::Ref<const Eigen::VectorXd>& signal);

/// Likewise of a signal from which so many drifts, steps or cycles were taken off that were found
/// by looking at it, which makes pieces of a random walk that each come back: rejects, at 1 %
/// (0.1 % where there are none), that it is one. No earlier changes beside the level, so that noise
/// within some blocks is enough.
[[nodiscard]] bool comes_back_beside_breaks(const Eigen::Ref<const Eigen::VectorXd>& signal,
                                            std::size_t breaks);
/// By how much the square of that test's statistic, which is about 2 ln of the likelihood of coming
/// back against that of a walk, is larger than where it rejects; negative where it does not.
[[nodiscard]] double beyond_a_walk(const Eigen::Ref<const Eigen::VectorXd>& signal,
                                   std::size_t breaks);

/// Whether it wanders: it does not come back, and is long enough to tell that from settling, for a
/// CV of which the slowest time constant takes so many rows.
[[nodiscard]] bool wanders(const Eigen::Ref<const Eigen::VectorXd>& signal, double slowest_rows);

}  // namespace mpm
