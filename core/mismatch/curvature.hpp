#pragma once

#include <optional>
#include <vector>

#include "core/mismatch/residual_regression.hpp"
#include "core/mismatch/volterra_terms.hpp"

namespace mpm {

/// That a CV's answer depends on where the plant is operated, which no linear model follows.
struct Curvature {
  double explained = 0.0;  ///< of the weighted residual, beyond linear errors, in its variances
  double p_value = 1.0;    ///< of no curvature
  /// Per input of the unit.
  struct Channel {
    double p_value = 1.0;  ///< of none in which this input has a part
    /// Two s.d. of the local gain over the rows, relative to the model's, without what noise makes
    /// of it.
    double gain_variation = 0.0;
    double sure_variation = 0.0;  ///< its lower bound, 99 % one-sided
    template <class Archive>
    void archive(Archive& a) {
      a(p_value, gain_variation, sure_variation);
    }
  };
  std::vector<Channel> channels;

  template <class Archive>
  void archive(Archive& a) {
    a(explained, p_value);
    a.varying(channels);
  }
};

/// Tests whether `terms` say more of a CV's residual than its past and any linear error of all
/// channels do: F over all rows of the CV's first memory, weighed as they are there (Billings and
/// Voon 1983 test residuals on such products). Nothing where the rows are too few to tell.
/// Allocates: it is asked only where something is off.
[[nodiscard]] std::optional<Curvature> find_curvature(const RegressionShape& shape, int cv,
                                                      const RegressionHistory& history,
                                                      const ResidualRegression& regression,
                                                      const VolterraTerms& terms);

}  // namespace mpm
