#include "daemon/report/page/page_parts.hpp"

#include <cmath>

#include "core/text/number_text.hpp"
#include "daemon/report/condensing/condensing_report.hpp"

namespace mpm::report {
namespace {

constexpr double kFewSettlings = 10.0;  ///< a record so long says little of slow channels

bool stands_still(const Eigen::Ref<const Eigen::VectorXd>& values) {
  double first = std::nan("");
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!std::isfinite(first)) first = value;
    if (value != first) return false;
  }
  return std::isfinite(first);
}

}  // namespace

std::string span_text(const Recording& recording, const Condensing& how, const Clock& clock) {
  const std::vector<Run> runs = runs_of(recording);
  const auto at = [&](Eigen::Index row) {
    return on_clock(recording,
                    recording.start_s + static_cast<double>(row) * recording.sample_time_s);
  };
  std::string text = counted(static_cast<std::uint64_t>(recording.samples()), "sample") + ", " +
                     duration(recording.sample_time_s) + " apart";
  if (how.any()) text += " (" + condensing_text(how, recording.samples()) + ")";
  if (runs.size() > 1) return text + ", in " + counted(runs.size(), "run");
  return text + ": " + clock.between(at(0), at(recording.samples() - 1));
}

std::vector<std::string> weak_data(const Recording& recording,
                                   const std::vector<std::string>& setpoints,
                                   Eigen::Index settling) {
  std::vector<std::string> warnings, still;
  for (std::size_t cv = 0; cv < setpoints.size(); ++cv) {
    const auto column = static_cast<Eigen::Index>(cv);
    if (column < recording.setpoints.cols() && stands_still(recording.setpoints.col(column)))
      still.push_back(setpoints[cv]);
  }
  if (!still.empty())
    warnings.push_back("Constant set-points: " + listed(still) +
                       (still.size() == 1 ? " does" : " do") +
                       " not move, so the loop's own feedback is most of what these data show. "
                       "Step set-points, or move MVs by hand, for data that say more.");
  const double settlings = static_cast<double>(recording.samples()) /
                           static_cast<double>(std::max<Eigen::Index>(1, settling));
  if (settlings < kFewSettlings)
    warnings.push_back(
        "Short: these data are " + rounded(settlings) +
        " settling times of the slowest channel long. Ten or more tell slow channels "
        "from drifts.");
  return warnings;
}

nlohmann::ordered_json facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& [name, text] : rows)
    if (!text.empty()) json.push_back({name, text});
  return json;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

}  // namespace mpm::report
