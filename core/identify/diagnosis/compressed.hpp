#pragma once

#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/statistics/historian.hpp"

namespace mpm {

/// Why a finding is refused, for a person.
inline constexpr const char* kMadeByCompression =
    "a historian has compressed the CV, and what it took away can look the same";

/// What a historian's compression leaves of CVs is off by up to its deadband for long: the
/// calibrated test takes that for wrong channels, and a search for steps, drifts and cycles.
class Compressed {
 public:
  /// No CV is.
  Compressed() = default;
  explicit Compressed(const Recording& recording);

  [[nodiscard]] bool any() const;
  [[nodiscard]] bool cv(int cv) const {
    return any() && traits_[static_cast<std::size_t>(cv)].compressed();
  }
  /// Whether compression may have made the finding: a disturbance that is no larger than some
  /// deadbands, or anything of a CV of which hardly more is left.
  [[nodiscard]] bool may_have_made(const Finding& finding) const;

 private:
  std::vector<HistorianTraits> traits_;  // per CV
};

}  // namespace mpm
