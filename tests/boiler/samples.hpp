#pragma once

#include <string>
#include <vector>

#include "config/unit_config.hpp"
#include "daemon/report/page/plot_json.hpp"

namespace mpm::boiler {

/// The unit of a file, which may lack a model. Throws StoryError.
[[nodiscard]] config::UnitConfig unit_of(const std::string& file);

/// The signals of a recording, one series each.
struct Samples {
  std::vector<report::Series> mvs, cvs, setpoints;
};
[[nodiscard]] Samples samples_of(const std::string& recording, const config::UnitConfig& unit);

/// The CVs that the unit's model gives when it runs freely on the measured inputs, each at the mean
/// level of the measured one.
[[nodiscard]] std::vector<report::Series> free_run(const config::UnitConfig& unit,
                                                   const Samples& measured);

[[nodiscard]] double mean_of(const report::Series& values);
/// Standard deviation, n - 1.
[[nodiscard]] double spread_of(const report::Series& values);
/// RMS of a - b.
[[nodiscard]] double rms_difference(const report::Series& a, const report::Series& b);

}  // namespace mpm::boiler
