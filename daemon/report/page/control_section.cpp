#include "daemon/report/page/control_section.hpp"

#include <cmath>
#include <string>

#include "core/text/number_text.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

std::string value(double number, const std::string& unit = {}) {
  return rounded(number, std::isfinite(number) ? unit : "");
}
std::string percent(double share) { return value(100.0 * share, "%"); }

Json cv_table(const PerformanceRecord& performance, double sample_time_s) {
  Json table{{"columns", {"CV", "control error, s.d.", "outside limits"}}, {"rows", Json::array()}};
  if (performance.cvs.empty()) return table;
  for (const HorizonError& horizon : performance.cvs.front().prediction)
    table["columns"].push_back(duration(static_cast<double>(horizon.samples) * sample_time_s) +
                               " ahead");
  for (const CvPerformance& cv : performance.cvs) {
    Json row = {cv.cv, value(std::sqrt(cv.control_error.variance), cv.engineering_unit),
                percent(cv.outside_limits)};
    for (const HorizonError& horizon : cv.prediction)
      row.push_back(std::isfinite(horizon.rmse)
                        ? value(horizon.rmse) + " (" + value(horizon.movement_rms) + ")"
                        : value(horizon.rmse));
    table["rows"].push_back(std::move(row));
  }
  return table;
}

Json mv_table(const PerformanceRecord& performance) {
  Json table{{"columns", {"MV", "at low limit", "at high limit", "travel per sample", "standing"}},
             {"rows", Json::array()}};
  for (const MvPerformance& mv : performance.mvs)
    table["rows"].push_back({mv.mv, percent(mv.at_low), percent(mv.at_high),
                             value(mv.travel, mv.engineering_unit), percent(mv.standing)});
  return table;
}

}  // namespace

Json control_section(const PerformanceRecord& performance, double sample_time_s) {
  const std::string acts =
      std::isfinite(performance.service_factor)
          ? "The controller acts in " + percent(performance.service_factor) + " of them."
          : "Whether the controller acts cannot be told.";
  return {{"text", counted(static_cast<std::uint64_t>(performance.samples), "sample") +
                       " of the whole recording. " + acts},
          {"cvs", cv_table(performance, sample_time_s)},
          {"mvs", mv_table(performance)},
          {"note",
           "Control error: measured minus set-point. Ahead: RMS error of predictions with the "
           "usual output-bias update and, in brackets, how much the CV itself moved in that time. "
           "Travel: mean absolute move. Standing: an MV that has kept one value for long."}};
}

}  // namespace mpm::report
