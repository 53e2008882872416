#pragma once

#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"

namespace mpm {

/// Why no model can be judged by these free-run residuals (samples x CVs, NaN where unknown), for a
/// person: they diverge, or a CV is hardly known. Empty where one can.
[[nodiscard]] std::string why_not_judged(const Eigen::MatrixXd& residuals);

/// The smallest share of what a CV does that a model with these free-run residuals explains beyond
/// a constant, over the CVs that were measured; <= 1, and negative where a constant does better.
[[nodiscard]] double least_explained(const Eigen::MatrixXd& residuals, const Eigen::MatrixXd& cvs);

/// Whether the errors of some CV are so much larger from row `first` on (`kGrown`) that the model,
/// with its level of before, explains it there less well than a constant does.
[[nodiscard]] bool loses_a_cv(const Eigen::MatrixXd& residuals, const Eigen::MatrixXd& cvs,
                              Eigen::Index first);

/// CVs whose loop swings as one with a sticking valve does, by shape tests that need no model: of
/// those on which one of the first `mvs` inputs alone acts. `model` in channels.
[[nodiscard]] std::vector<int> sticking_loops(const ModelSpec& model, int mvs,
                                              const Recording& recording);

/// What the free runs say of the model as it was given.
struct FreeRunVerdict {
  double explained = 1.0;  ///< `least_explained`
  bool sticks = false;     ///< there is a loop that does
  bool loses = false;      ///< `loses_a_cv`, in the rows that were not fitted
};

/// Verdict and reason from that, and all else that the diagnosis holds.
void decide(const FreeRunVerdict& free_runs, Diagnosis& diagnosis);

}  // namespace mpm
