#include "tests/boiler/chapters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text/number_text.hpp"
#include "daemon/report/page/page_parts.hpp"
#include "daemon/report/page/wording.hpp"
#include "tests/boiler/figures.hpp"
#include "tests/boiler/hidden_changes.hpp"
#include "tests/boiler/samples.hpp"
#include "tests/boiler/tables.hpp"

namespace mpm::boiler {
namespace {

using report::duration;
using report::Role;
using report::rounded;

Json chapter(const std::string& title) {
  return {{"title", title},         {"text", Json::array()},   {"tables", Json::array()},
          {"plots", Json::array()}, {"groups", Json::array()}, {"made", Json::array()}};
}

Json table(const std::string& title, const std::vector<std::string>& columns) {
  return {{"title", title}, {"columns", columns}, {"rows", Json::array()}};
}

void say(Json& chapter, const std::string& text) { chapter["text"].push_back(text); }

void made_by(Json& chapter, const std::string& what, const std::vector<Command>& commands) {
  for (const Command& command : commands)
    chapter["made"].push_back({&command == &commands.front() ? what : "", typed(command)});
}

std::string length_of(const config::UnitConfig& unit, int samples) {
  return counted(static_cast<std::uint64_t>(samples), "sample") + " (" +
         duration(samples * unit.sample_time_s) + ")";
}

/// "3 channels mismatch, 9 match and 4 are undetermined."
std::string verdicts_said(const Json& detect) {
  const int wrong = count_of(detect, "mismatch"), right = count_of(detect, "match");
  const int open = count_of(detect, "undetermined");
  return std::to_string(wrong) + " mismatch, " + std::to_string(right) + " match, " +
         std::to_string(open) + " undetermined";
}

std::string same_answer_said(const std::vector<const LiveRun*>& runs) {
  const auto same =
      std::count_if(runs.begin(), runs.end(), [](const LiveRun* run) { return run->same_answer; });
  return std::cmp_equal(same, runs.size())
             ? "What mpmd published live and what mpm detect says of the recording are the same, "
               "to "
               "the last digit."
             : "What mpmd published live differs from what mpm detect says of the recording.";
}

/// In one piece, so that no line ends within it.
std::string since(const Json& onset) {
  if (!onset.is_number()) return {};
  std::string text = onset > 0.0 ? duration(onset.get<double>()) : "start";
  const std::size_t blank = text.find(' ');
  return blank == std::string::npos ? text : text.replace(blank, 1, "\u00a0");
}

std::string confidence_text(const Json& finding) {
  const double confidence = finding["confidence"];
  return confidence > 0.999 ? "> 99.9 %" : rounded(100.0 * confidence, "%");
}

}  // namespace

Json rest_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kPlant);
  const Samples samples = samples_of(story.rest, unit);
  Json result = chapter("1 The plant at rest");
  say(result,
      "The plant is simulated from its balances of mass, carbon and energy under low-level "
      "control; the monitor is told nothing of them. The controller is off and the MVs "
      "stand at Table 5.4.");
  Json values = table("Steady state, beside Table 5.4", {"signal", "Table 5.4", "here"});
  for (std::size_t i = 0; i < unit.mv.size(); ++i)
    values["rows"].push_back({unit.mv[i].description + ", " + unit.mv[i].tag,
                              rounded(thesis::kRestMv[i], unit.mv[i].unit),
                              rounded(mean_of(samples.mvs[i]), unit.mv[i].unit)});
  for (std::size_t j = 0; j < unit.cv.size(); ++j)
    values["rows"].push_back({unit.cv[j].description + ", " + unit.cv[j].tag,
                              rounded(thesis::kRestCv[j], unit.cv[j].unit),
                              rounded(mean_of(samples.cvs[j]), unit.cv[j].unit)});
  values["note"] = "Here: mean of " + length_of(unit, story.plan.rest) +
                   ". The thesis prints the tertiary air in m3/h; 30 m3/h would be nothing beside "
                   "135 m3/h of liquor, so it is taken for m3/s.";
  result["tables"].push_back(values);
  made_by(result, "data", story.made_rest);
  return result;
}

Json model_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kCommissionedModel);
  const Samples measured = samples_of(story.validation, unit);
  const std::vector<report::Series> simulated = free_run(unit, measured);
  const Json& channels = story.identified["channels"];
  const auto found = std::count_if(channels.begin(), channels.end(), [](const Json& channel) {
    return channel["in_model"].get<bool>();
  });
  Json result = chapter("2 A model from a test");
  say(result,
      "All MVs move between two levels at random for " + length_of(unit, story.plan.test) +
          ". From the tags alone mpm identify finds " + std::to_string(found) + " of " +
          std::to_string(channels.size()) +
          " channels; the thesis has 14. Step responses: shaded is the 95 % interval, dotted "
          "the end of the axis in figure 5.2.");
  Json fit = table("Free run on another test", {"CV", "error, RMS", "CV moves by, s.d."});
  for (std::size_t j = 0; j < unit.cv.size(); ++j)
    fit["rows"].push_back({unit.cv[j].description,
                           rounded(rms_difference(measured.cvs[j], simulated[j]), unit.cv[j].unit),
                           rounded(spread_of(measured.cvs[j]), unit.cv[j].unit)});
  fit["note"] = "The model runs on the inputs of " + length_of(unit, story.plan.test / 3) +
                " with another seed and sees no CV but its mean.";
  result["tables"].push_back(fit);
  result["plots"] = step_responses(unit, story.identified);
  result["groups"].push_back(
      free_run_figure("Free run on another test", unit, measured, simulated));
  made_by(result, "test and model", story.made_model);
  made_by(result, "other test", story.made_validation);
  return result;
}

Json commissioning_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kCommissionedModel);
  const Samples samples = samples_of(story.commissioned.recording, unit);
  Json result = chapter("3 Commissioning");
  say(result, "The MPC runs with that model; nothing is hidden. " +
                  length_of(unit, story.plan.compare) + ".");
  result["tables"] = control_tables(unit, {{"here", control_of(story.commissioned.detect)},
                                           {"thesis, Table 5.6", thesis::kCommissioned}});
  result["tables"][0]["note"] =
      "The thesis moves its set-points otherwise: what compares is how they change from chapter to "
      "chapter.";
  const std::vector<Drawn> drawn = {{"measured", Role::kMeasured, samples}};
  result["groups"].push_back(cv_figure("Reference tracking (figure 5.3)", unit, drawn));
  result["groups"].push_back(mv_figure("Inputs and their limits (figure 5.4)", unit, drawn));
  made_by(result, "run and indices", story.commissioned.commands);
  return result;
}

Json change_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kCommissionedModel);
  const Samples before = samples_of(story.commissioned.recording, unit);
  const Samples after = samples_of(story.mismatch.recording, unit);
  Json result = chapter("4 A hidden change");
  say(result,
      "CO burns to CO2 quicker by a tenth from the first sample on. Set-points and noise are "
      "those of chapter 3; the model is the old one.");
  const std::string alarms = alarms_said(story.changed.detect);
  say(result, "The monitor sees " + length_of(unit, story.plan.watch) +
                  " of each plant. Changed: " + verdicts_said(story.changed.detect) +
                  "; in alarm: " + alarms + ". Unchanged: " + verdicts_said(story.healthy.detect) +
                  "; in alarm: " + alarms_said(story.healthy.detect) + ".");
  if (alarms == "none")
    say(result,
        "So the change raises no alarm: what the channels show of it is less than what the monitor "
        "takes to matter.");
  if (alarms_said(story.healthy.detect) != "none")
    say(result, "Nothing is hidden in the unchanged plant: its alarms are false.");
  for (const LiveRun* run : {&story.changed, &story.healthy}) {
    if (run->detect["channels"].dump().find("operating_point") == std::string::npos) continue;
    say(result, "Operating point: how the CV answers depends on where the plant runs.");
    break;
  }
  say(result,
      same_answer_said({&story.commissioned, &story.mismatch, &story.changed, &story.healthy}));
  result["tables"] = control_tables(unit, {{"commissioning", control_of(story.commissioned.detect)},
                                           {"mismatch", control_of(story.mismatch.detect)},
                                           {"thesis, commissioning", thesis::kCommissioned},
                                           {"thesis, mismatch", thesis::kMismatch}});
  result["tables"].push_back(
      verdict_table("What the monitor says of the changed plant", unit, story.changed.detect));
  result["tables"].push_back(
      verdict_table("What it says of the unchanged plant", unit, story.healthy.detect));
  const std::vector<Drawn> drawn = {{"commissioning", Role::kAfter, before},
                                    {"mismatch", Role::kBefore, after}};
  result["groups"].push_back(cv_figure("Reference tracking (figure 5.5)", unit, drawn));
  result["groups"].push_back(mv_figure("Inputs and their limits (figure 5.6)", unit, drawn));
  made_by(result, "figures and indices", story.mismatch.commands);
  made_by(result, "verdicts, changed", story.changed.commands);
  made_by(result, "verdicts, unchanged", story.healthy.commands);
  return result;
}

Json diagnosis_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kCommissionedModel);
  const Json& findings = story.diagnosis["findings"];
  Json result = chapter("5 Diagnosis and a small test");
  say(result, findings.empty() ? "Of the changed run mpm diagnose names nothing: " +
                                     story.diagnosis["verdict"].get<std::string>() + "."
                               : "Of the changed run mpm diagnose has " +
                                     counted(findings.size(), "finding") + ", below.");
  if (!findings.empty()) {
    Json named = table("Findings", {"finding", "confidence", "which is", "in its words"});
    for (const Json& finding : findings)
      named["rows"].push_back({place_of(finding), confidence_text(finding),
                               judged("co_oxidation", finding, story.healthy_diagnosis),
                               finding["explanation"]});
    result["tables"].push_back(named);
  }
  made_by(result, "diagnosis", story.made_diagnosis);
  if (story.suspected_cvs.empty()) return result;

  say(result, "Only the channels of " + report::listed(story.suspected_cvs) +
                  " are identified again, from " + length_of(unit, story.plan.test) +
                  " of test signals on the changed plant. All other channels keep their numbers.");
  std::vector<std::string> point;
  for (std::size_t i = 0; i < unit.mv.size(); ++i)
    point.push_back(unit.mv[i].description + " " +
                    rounded(story.test_point.at(i), unit.mv[i].unit));
  say(result,
      "The MVs move about where the controller now holds them: " + report::listed(point) +
          ". The test of chapter 2 moved about Table 5.4, so the new numbers differ by what "
          "the plant's curvature makes of that, too.");
  Json gains = table("Gains, old and new", {"channel", "old", "new", "95 % interval", "unit"});
  for (const Json& channel : story.identified_again["channels"]) {
    if (!channel["in_model"].get<bool>()) continue;
    double old = std::nan("");
    for (const Json& before : story.identified["channels"])
      if (before["mv"] == channel["mv"] && before["cv"] == channel["cv"] && before.contains("gain"))
        old = before["gain"];
    const double gain = channel["gain"], low = channel["interval"]["gain"][0],
                 high = channel["interval"]["gain"][1];
    std::string per;
    for (const config::InputSignal& mv : unit.mv)
      if (channel["mv"] == mv.tag) per = mv.unit;
    for (const config::CvSignal& cv : unit.cv)
      if (channel["cv"] == cv.tag) per = cv.unit + " per " + per;
    gains["rows"].push_back(
        {channel["mv"].get<std::string>() + " \u2192 " + channel["cv"].get<std::string>(),
         rounded(old, low, high), rounded(gain, low, high), report::interval(gain, low, high),
         per});
  }
  result["tables"].push_back(gains);
  made_by(result, "test and new channels", story.made_repair);
  return result;
}

Json repair_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kRepairedModel);
  const Samples before = samples_of(story.mismatch.recording, unit);
  const Samples after = samples_of(story.repaired.recording, unit);
  Json result = chapter("6 The repaired model");
  say(result,
      "The changed plant with the updated model in controller and monitor; set-points and "
      "noise as before. " +
          same_answer_said({&story.repaired}));
  result["tables"] = control_tables(unit, {{"commissioning", control_of(story.commissioned.detect)},
                                           {"mismatch", control_of(story.mismatch.detect)},
                                           {"repaired", control_of(story.repaired.detect)}});
  const std::vector<Drawn> drawn = {{"mismatch", Role::kBefore, before},
                                    {"repaired", Role::kAfter, after}};
  result["groups"].push_back(cv_figure("Reference tracking", unit, drawn));
  result["groups"].push_back(mv_figure("Inputs and their limits", unit, drawn));
  made_by(result, "run and indices", story.repaired.commands);
  return result;
}

Json others_chapter(const Story& story) {
  const config::UnitConfig unit = unit_of(kCommissionedModel);
  Json result = chapter("7 Other hidden changes");
  say(result, "One run of " + length_of(unit, story.plan.watch) +
                  " each, with the model of chapter 2. Recordings of the bus hold no auxiliary "
                  "measurements; of the run that one of them sees, a file with all of them is "
                  "diagnosed as well.");
  Json found =
      table("Hidden and found", {"hidden", "found", "since", "confidence", "which is", "alarms"});
  const auto add = [&](std::string hidden, std::string alarms, const Json& diagnosis,
                       const std::string& scenario) {
    if (diagnosis["findings"].empty())
      found["rows"].push_back({hidden, "nothing", "", "", "", alarms});
    for (const Json& finding : diagnosis["findings"]) {
      found["rows"].push_back({std::exchange(hidden, ""), place_of(finding),
                               since(finding["onset"]), confidence_text(finding),
                               judged(scenario, finding, story.healthy_diagnosis),
                               std::exchange(alarms, "")});
    }
  };
  add("nothing", alarms_said(story.healthy.detect), story.healthy_diagnosis, "none");
  made_by(result, "nothing hidden", story.healthy.commands);
  for (const HiddenChange& change : story.others) {
    add(change.description, alarms_said(change.run.detect), change.diagnosis, change.scenario);
    if (!change.with_aux.is_null())
      add("the same run, with auxiliary measurements", "", change.with_aux, change.scenario);
    made_by(result, change.scenario, change.run.commands);
  }
  found["note"] = "Since: time from the start of the run, where a moment was found.";
  result["tables"].push_back(found);
  return result;
}

}  // namespace mpm::boiler
