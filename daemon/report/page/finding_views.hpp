#pragma once

#include <vector>

#include "daemon/report/page/channel_numbers.hpp"
#include "daemon/report/page/plot_json.hpp"

/// What a finding looks like in the data.
namespace mpm::report {

/// {title, finding, plots}: measured, simulated and extended over the most telling two settling
/// times of each finding; where there is no finding, of each CV, the worst first, a few at most.
[[nodiscard]] Json telling_views(const DiagnosisRun& run);

/// The finding's own picture: static curve, valve plot, step responses, lag correlation,
/// disturbance or noise over time. Empty where the telling view is all there is to see.
[[nodiscard]] Json pictures(const DiagnosisRun& run, const Finding& finding,
                            const std::vector<ChannelNumbers>& channels);

/// How a CV's residuals go with an input some samples earlier; [] where the input does not move.
[[nodiscard]] Json lag_plot(const DiagnosisRun& run, int cv, const std::string& tag,
                            const Eigen::Ref<const Eigen::VectorXd>& input);

/// Rows until a simulation has forgotten that how the plant was before is not known.
[[nodiscard]] Eigen::Index settling_rows(const DiagnosisRun& run, Eigen::Index rows);

}  // namespace mpm::report
