#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/identify/diagnosis/diagnosis.hpp"
#include "tests/hidden/hidden_case.hpp"

/// How well a diagnosis says what was hidden.
///
/// Right cause: the first finding's; of two hidden causes each among the findings, in any order;
/// of nothing hidden the verdict `match` without a finding; of an effect that no cause means the
/// verdict `mismatch` without a finding of confidence kConfident or more. Where one effect has
/// two names, either is right:
/// * the gain of a channel that is its input's (its CV's) only one is input_scale (output_scale);
/// * `dynamics` may be said as two or three findings on the same channel.
/// `dynamics` for an error of one kind is wrong, and so is one kind for `dynamics`.
namespace mpm::hidden {

inline constexpr double kConfident = 0.8;
inline constexpr const char* kFailed = "failed";  ///< named where `diagnose` threw

struct ParameterScore {
  std::string name;
  bool covered = false;  ///< the true value lies in the stated interval
  double error = 0.0;    ///< |value - true|, in shares of the true deviation from the model
};

struct CaseScore {
  CaseRequest request;
  std::string named;  ///< cause of the first finding, or none, undetermined, unnamed
  bool cause_right = false;
  std::optional<bool>
      place_right;  ///< the right signals among those named, where the cause is right
  std::optional<bool> kind_right;          ///< where the place is right and there are kinds
  int extra = 0;                           ///< findings that answer to nothing hidden
  std::vector<ParameterScore> parameters;  ///< that were stated, where the place is right
  bool has_onset = false;
  std::optional<double> onset_error;  ///< samples; where one was stated at the right place
  /// Root of the mean of (rmse / the true plant's rmse)^2 on the samples not fitted, of the CVs in
  /// which something is hidden (all where nothing is); NaN =
  /// the diagnosis says nothing.
  double rmse_before = 0.0, rmse_after = 0.0;
  double seconds = 0.0;
  std::string truth, answer;  ///< for a person
};

[[nodiscard]] CaseScore score(const HiddenCase& hidden, const Diagnosis& diagnosis, double seconds);

/// Draws the case, diagnoses it and scores that.
[[nodiscard]] CaseScore score_one(const CaseRequest& request);

/// What was hidden, in one line.
[[nodiscard]] std::string describe(const HiddenCase& hidden);

}  // namespace mpm::hidden
