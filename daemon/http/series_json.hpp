#pragma once

#include "daemon/http/unit_json.hpp"

namespace mpm::http {

/// What of a CV's past is asked for, s since 1970; what is not given: the last samples.
struct SeriesQuery {
  static constexpr int kFewestPoints = 10, kMostPoints = 2000, kUsualPoints = 600;

  std::optional<double> from_s, until_s;
  std::optional<double> span_s;  ///< before the end, where no beginning is given
  int points = kUsualPoints;
};

/// Measured, prediction, set-point, residual and the inputs over time: means, with the least and
/// the greatest of what is put together, null where nothing is known.
[[nodiscard]] Json series_json(const UnitStore& store, int cv, const SeriesQuery& query);

}  // namespace mpm::http
