#pragma once

#include <optional>
#include <vector>

#include "core/identify/causes/finding.hpp"
#include "core/identify/diagnosis/nameable.hpp"
#include "core/identify/search/search.hpp"

namespace mpm {

struct Late {
  std::vector<Finding> findings;
  std::vector<Finding> doubted;  ///< what may as well be something that is no fault
};

/// What begins in the rows that were kept to measure repairs on, from `first` on. No search of the
/// rows before can find it, and a verdict that knows nothing of it would be of the past. `model`,
/// with aux inputs, is the extended one; only effects with an onset there are looked for, and only
/// where a CV's residual is larger there than before, and which `settings.may_name`. None of them
/// is repaired: no rows are left that could judge it.
[[nodiscard]] Late find_late(const ModelSpec& model, int model_inputs, const Recording& recording,
                             Eigen::Index first, const SearchSettings& settings);

/// The same where a channel may be named only if the calibrated test rejects it beyond doubt on
/// those rows, and not so on the rows before. `model` and `recording` have set-points behind the
/// aux signals; `tested` and `measured`, of the test, have not. `outside_shares` per input.
[[nodiscard]] Late begun_late(const ModelSpec& model, const ModelSpec& tested,
                              const Recording& recording, const Recording& measured,
                              Eigen::Index first, const SignalRanges& ranges,
                              const std::vector<std::optional<double>>& outside_shares,
                              SearchSettings settings);

/// Why what is accused late is not named, for a person.
inline constexpr const char* kMayBeRefused =
    "something of this CV's channels was refused before: what begins late may be that";

/// Whether a late finding accuses a channel, an actuator or a sensor of a CV of which something
/// that acts through channels was `refused`: that something is wrong there is no news, and nobody
/// knows what.
[[nodiscard]] bool may_be_refused(const Finding& late, const std::vector<Effect>& refused,
                                  const ModelSpec& model);

}  // namespace mpm
