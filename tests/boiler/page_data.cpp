#include "tests/boiler/page_data.hpp"

#include "daemon/report/page/page_parts.hpp"
#include "daemon/report/page/wording.hpp"
#include "idl/version.hpp"
#include "tests/boiler/chapters.hpp"
#include "tests/boiler/tables.hpp"

namespace mpm::boiler {
namespace {

/// CO is the CV that the change acts on.
constexpr std::size_t kCo = 3;

std::string variance(const LiveRun& run) {
  return report::rounded(control_of(run.detect).variance[kCo]);
}

std::string sentence(const Story& story) {
  return "The variance of the CO control error is " + variance(story.commissioned) +
         "\u00a0ppm\u00b2 at commissioning, " + variance(story.mismatch) +
         "\u00a0ppm\u00b2 after a hidden change and " + variance(story.repaired) +
         "\u00a0ppm\u00b2 with the repaired model.";
}

}  // namespace

Json page_data(const Story& story) {
  Json json{{"title", "The life of an MPC model"},
            {"kicker", "The life of an MPC model on a simulated recovery boiler"},
            {"zone", ""},
            {"sentence", sentence(story)},
            {"details",
             "Beside Carlsson (2010), chapter 5: identification, commissioning, a hidden "
             "change, its diagnosis, the repair. Controller, monitor and recorder are "
             "separate processes that talk over DDS."},
            {"data",
             "Control interval 10 s. All times are process time. One draw of set-points and noise: "
             "another seed gives other numbers, verdicts and findings."}};
  json["chapters"] = {rest_chapter(story),   model_chapter(story),     commissioning_chapter(story),
                      change_chapter(story), diagnosis_chapter(story), repair_chapter(story),
                      others_chapter(story)};
  json["made_by"] =
      report::facts({{"Command", "./run boiler --seed " + std::to_string(story.plan.seed)},
                     {"Program", idl::version_text("mpm_boiler")},
                     {"Took", report::rounded(story.seconds, "s")}});
  return json;
}

}  // namespace mpm::boiler
