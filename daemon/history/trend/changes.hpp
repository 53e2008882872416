#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/history/trend/trend.hpp"

namespace mpm::history {

/// What changed beyond what chance gives: a channel's gain, or how large a CV's prediction errors
/// are.
struct Change {
  std::string mv, cv;                    ///< `mv` empty: of the CV's prediction errors
  bool gradual = false;                  ///< along a line; else at once
  std::size_t first = 0;                 ///< period since when
  std::optional<std::int64_t> alarm_ns;  ///< when its alarm rose, where one did about then
  /// Of a gain its error before the change and in the last period that is known, with the interval
  /// of that (units as in ChannelDigest). Of prediction errors 1, and how many times as large they
  /// have become.
  double before = 0.0, now = 0.0, low = 0.0, high = 0.0;
  double movement_ratio = 1.0;  ///< of prediction errors: the movement's likewise
  double p_value = 1.0;         ///< of no change
};

/// A channel in alarm after the last sample whose gain is not said to have changed: it was wrong
/// all along, or the periods are too few.
struct Standing {
  std::string mv, cv;
  std::optional<std::int64_t> since_ns;  ///< none: since before the first sample
  double gain_error = kUnknown, low = kUnknown, high = kUnknown;
};

/// A channel of which the last periods say nothing.
struct Silence {
  ChannelDigest last;                ///< why
  std::optional<std::size_t> since;  ///< period; none: ever
};

struct Findings {
  std::vector<Change> changes;  ///< CVs in their order, then channels
  std::vector<Standing> standing;
  std::vector<Silence> silent;
  std::size_t asked =
      0;  ///< series with enough periods to show a change; where 0, nothing can be told
};

/// Each series of periods is asked for its likeliest change (`find_level_change`), at
/// kFalseRate for all of them together. Of a gain it must be as large as matters, of
/// prediction errors kLeastRatio.
[[nodiscard]] Findings find_changes(const Trend& trend);

}  // namespace mpm::history
