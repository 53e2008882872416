#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"

namespace mpm::files {

/// Step responses from a table, one row for each channel: `cv,mv,<coefficients per sample>`.
struct StepTable {
  std::vector<ChannelSpec> channels;  ///< all of them StepResponse, in the order of the rows
  std::vector<std::string> notices;
};

/// Comma, semicolon or tab between the cells; with the latter two a comma is a decimal comma. A
/// first line `cv,mv,0,10,20,...` may give the times of the coefficients (s), from 0 or from one
/// sample time on, and have columns `cv_unit` and `mv_unit` before them, which are compared with
/// the unit file's. Without times the first column is the moment of the step, unless a row does not
/// begin with 0 there: then it is one sample later. Throws config::InputError with the place of an
/// unknown tag, of a second row of a channel, a row of another length, what is no number, times
/// that are not the unit's sample_time apart, another engineering unit.
[[nodiscard]] StepTable read_step_table(const std::string& path, const config::UnitConfig& unit);

}  // namespace mpm::files
