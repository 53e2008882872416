#include "daemon/report/condensing/condensing_report.hpp"

#include "core/text/number_text.hpp"

namespace mpm::report {

std::string condensing_text(const Condensing& how, Eigen::Index samples) {
  if (!how.any()) return {};
  std::string text = "of " + counted(static_cast<std::uint64_t>(how.given), "sample") + " ";
  if (how.every > 1) text += "each " + std::to_string(how.every) + " were averaged into one";
  if (how.every > 1 && how.stretches > 0) text += ", and of these ";
  if (how.stretches > 0)
    text += std::to_string(how.stretches) +
            (how.stretches == 1 ? " stretch was" : " stretches were") +
            " taken in which most moves, ";
  else
    text += ", ";
  return text + counted(static_cast<std::uint64_t>(samples), "sample") + " together";
}

nlohmann::ordered_json condensing_json(const Condensing& how) {
  return {{"samples_given", how.given}, {"averaged", how.every}, {"stretches", how.stretches}};
}

}  // namespace mpm::report
