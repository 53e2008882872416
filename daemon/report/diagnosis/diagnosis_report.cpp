#include "daemon/report/diagnosis/diagnosis_report.hpp"

#include <cstdio>

#include "core/identify/causes/cause.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/condensing/condensing_report.hpp"
#include "daemon/report/diagnosis/data_notes.hpp"
#include "daemon/report/diagnosis/explain.hpp"
#include "daemon/report/diagnosis/names_of.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

Json tag_or_null(const std::string& tag) { return tag.empty() ? Json(nullptr) : Json(tag); }

/// Keys that say what a finding or a rival is about.
Json subject_json(const Subject& subject, const SignalNames& names) {
  const Place& place = subject.place;
  // What a model leaves out may be an input of other channels of it: then both keys name it.
  const bool by_tag = place.aux >= 0 || subject.cause->names_its_source();
  return {
      {"cause", subject.cause->name().text},
      {"cv", tag_or_null(place.cv >= 0 ? names.cv(place.cv).tag : "")},
      {"mv", tag_or_null(place.input >= 0 && place.aux < 0 ? names.input(place.input).tag : "")},
      {"tag", tag_or_null(by_tag ? names.source(place).tag : "")}};
}

void add_kind(const Cause& cause, Json& json) {
  if (*cause.kind() != '\0') json[cause.name().kind_key] = cause.kind();
}

Json parameters_json(const Finding& finding, const SignalNames& names) {
  const Cause& cause = *finding.subject.cause;
  Json json = Json::object();
  add_kind(cause, json);
  if (finding.other_input >= 0) json["of"] = names.input(finding.other_input).tag;
  for (const Parameter& parameter : finding.parameters) json[parameter.name()] = parameter.value;
  if (cause.has_onset_parameter() && finding.onset_s && !json.contains("onset"))
    json["onset"] = *finding.onset_s;
  return json;
}

Json interval_json(const Parameter& parameter) {
  return Json::array({parameter.low, parameter.high});
}

Json rival_json(const DiagnosisRun& run, const Rival& rival, const SignalNames& names) {
  Json json = subject_json(rival.subject, names);
  add_kind(*rival.subject.cause, json);
  json["worse"] = rival.worse;
  json["inseparable"] = rival.inseparable;
  json["text"] = rival_text(run, rival);
  return json;
}

Json finding_json(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names = names_of(run);
  Json json = subject_json(finding.subject, names);
  json["title"] = finding.subject.cause->name().title;
  json["parameters"] = parameters_json(finding, names);
  json["interval"] = Json::object();
  json["units"] = Json::object();
  for (const Parameter& parameter : finding.parameters) {
    json["interval"][parameter.name()] = interval_json(parameter);
    json["units"][parameter.name()] =
        names.unit_text(parameter.quantity->unit, finding.subject.place);
  }
  json["confidence"] = finding.confidence;
  json["onset"] = finding.onset_s ? Json(*finding.onset_s) : Json(nullptr);
  json["explanation"] = explain(run, finding);
  json["against"] = Json::array();
  json["rivals"] = Json::array();
  for (const Rival& rival : finding.rivals) {
    json["against"].push_back(rival_text(run, rival));
    json["rivals"].push_back(rival_json(run, rival, names));
  }
  json["evidence"] = finding.evidence;
  json["in_model"] = finding.repaired;
  if (!finding.refused.empty()) json["refused"] = finding.refused;
  if (finding.with) {
    json["with"] = subject_json(*finding.with, names);
    json["with"]["text"] = needed_text(names, finding);
  }
  json["explains"] = finding.explains;
  return json;
}

Json findings_json(const DiagnosisRun& run, const std::vector<Finding>& findings) {
  Json json = Json::array();
  for (const Finding& finding : findings) json.push_back(finding_json(run, finding));
  return json;
}

/// In samples of the unit.
Json horizons_json(const CvScore& score, Eigen::Index every) {
  Json json = Json::array();
  for (const Horizon& horizon : score.horizons)
    json.push_back({{"samples", horizon.samples * every},
                    {"rmse_before", horizon.rmse_before},
                    {"rmse_after", horizon.rmse_after}});
  return json;
}

Json inputs_json(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
  Json json = Json::array();
  for (const InputMovement& movement : run.diagnosis.inputs)
    json.push_back(
        {{"mv", names.input(movement.input).tag},
         {"outside_share", movement.outside_share ? Json(*movement.outside_share) : Json(nullptr)},
         {"excited", movement.excited}});
  return json;
}

/// What may not be named and would explain most, or null.
Json suspect_json(const DiagnosisRun& run) {
  if (!run.diagnosis.suspect) return nullptr;
  const SignalNames names = names_of(run);
  Json json = subject_json(run.diagnosis.suspect->subject, names);
  json["evidence"] = run.diagnosis.suspect->evidence;
  json["text"] = names.subject(run.diagnosis.suspect->subject);
  return json;
}

Json scores_json(const DiagnosisRun& run) {
  Json json = Json::array();
  for (std::size_t cv = 0; cv < run.diagnosis.scores.size(); ++cv) {
    const CvScore& score = run.diagnosis.scores[cv];
    json.push_back({{"cv", run.unit.cv.at(cv).tag},
                    {"rmse_before", score.rmse_before},
                    {"rmse_after", score.rmse_after},
                    {"fit_before", score.fit_before},
                    {"fit_after", score.fit_after},
                    {"gain_interval", {score.gain_low, score.gain_high}},
                    {"level_after", score.level_after},
                    {"refused", score.refused},
                    {"unit", run.unit.cv[cv].unit},
                    {"horizons", horizons_json(score, run.condensing.every)}});
  }
  return json;
}

Json channels_json(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
  Json json = Json::array();
  for (const ChannelEstimate& channel : run.diagnosis.channels) {
    Json entry{{"cv", names.cv(channel.cv).tag}, {"mv", names.input(channel.input).tag}};
    for (const Parameter* parameter :
         {&channel.gain_ratio, &channel.time_constant_ratio, &channel.dead_time_error}) {
      entry["parameters"][parameter->name()] = parameter->value;
      entry["interval"][parameter->name()] = interval_json(*parameter);
    }
    json.push_back(std::move(entry));
  }
  return json;
}

Json unexplained_json(const DiagnosisRun& run) {
  const SignalNames names = names_of(run);
  Json json = Json::array();
  for (const Unexplained& left : run.diagnosis.unexplained) {
    const Place& place = left.subject.place;
    json.push_back({{"cv", names.cv(place.cv).tag},
                    {"mv", tag_or_null(place.input >= 0 ? names.input(place.input).tag : "")},
                    {"manner", left.subject.cause->kind()},
                    {"p_value", left.p_value},
                    {"share", left.share},
                    {"text", unexplained_text(run, left)}});
  }
  return json;
}

Json closed_loop_json(const DiagnosisRun& run) {
  if (!run.closed_loop) return nullptr;
  const ClosedLoop& loop = *run.closed_loop;
  Json json{{"scenario", loop.scenario},
            {"seeds", loop.seeds},
            {"samples", loop.samples},
            {"inputs_left_out", loop.inputs_left_out}};
  json["cvs"] = Json::array();
  json["mvs"] = Json::array();
  for (const ClosedLoop::Cv& cv : loop.cvs)
    json["cvs"].push_back({{"cv", run.unit.cv.at(static_cast<std::size_t>(cv.cv)).tag},
                           {"error_variance_before", cv.variance_before},
                           {"error_variance_after", cv.variance_after}});
  for (const ClosedLoop::Mv& mv : loop.mvs)
    json["mvs"].push_back({{"mv", run.unit.mv.at(static_cast<std::size_t>(mv.mv)).tag},
                           {"at_limit_before", mv.at_limit_before},
                           {"at_limit_after", mv.at_limit_after}});
  return json;
}

/// Each run, from its first row to its last.
Json used_json(const Recording& recording) {
  Json json = Json::array();
  const auto clock_at = [&](Eigen::Index row) {
    return on_clock(recording,
                    recording.start_s + static_cast<double>(row) * recording.sample_time_s);
  };
  for (const auto& [first, count] : runs_of(recording))
    json.push_back({{"from", clock_at(first)}, {"until", clock_at(first + count - 1)}});
  return json;
}

std::string finding_text(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names = names_of(run);
  std::string text = names.subject(finding.subject);
  text += "  (confidence " + confidence_text(finding.confidence) + ")\n     " +
          explain(run, finding) + '\n';
  for (const Parameter& parameter : finding.parameters) {
    const std::string unit = names.unit_text(parameter.quantity->unit, finding.subject.place);
    text += "     " + parameter.name() + " " + number_text(parameter.value) + "  [" +
            interval_text(parameter.low, parameter.high) + "]" + (unit.empty() ? "" : " " + unit) +
            '\n';
  }
  if (!finding.repaired && !finding.refused.empty())
    text += "     not in the extended model: " + finding.refused + '\n';
  if (finding.with)
    text += "     its repair helps only with that of: " + needed_text(names, finding) + '\n';
  for (const Rival& rival : finding.rivals)
    if (rival.inseparable) text += "     or: " + rival_text(run, rival) + '\n';
  return text;
}

/// Of a free run that is off by more than the CV moves, as that of a level soon is, no number.
std::string fit_text(double percent) {
  if (percent < 0.0) return "< 0 %";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", percent);
  return text;
}

std::string score_table(const DiagnosisRun& run) {
  std::string text =
      "\n  on samples that the fit has not seen (" +
      std::to_string(run.diagnosis.validation_samples) +
      "):\n    CV            RMSE before    after   fit before    after   error less by\n";
  for (std::size_t cv = 0; cv < run.diagnosis.scores.size(); ++cv) {
    const CvScore& score = run.diagnosis.scores[cv];
    char line[200];
    std::snprintf(line, sizeof line, "    %-12s %12s %8s %12s %8s   ",
                  run.unit.cv.at(cv).tag.c_str(), number_text(score.rmse_before).c_str(),
                  number_text(score.rmse_after).c_str(), fit_text(score.fit_before).c_str(),
                  fit_text(score.fit_after).c_str());
    text += line;
    if (score.refused)
      text += "an extension was tried and did not carry over";
    else if (!score.judged)
      text += "not judged: read now and then";
    else if (score.gain_low == score.gain_high)
      text += "unchanged";
    else
      text += interval_text(100.0 * score.gain_low, 100.0 * score.gain_high, 2) + " %";
    text += '\n';
  }
  return text;
}

std::string loop_table(const DiagnosisRun& run) {
  const ClosedLoop& loop = *run.closed_loop;
  std::string text = "\n  in closed loop on scenario " + loop.scenario + " (" +
                     std::to_string(loop.seeds.size()) + " x " + std::to_string(loop.samples) +
                     " samples):\n";
  const auto row = [&text](const std::string& tag, const char* what, double before, double after) {
    char line[160];
    std::snprintf(line, sizeof line, "    %-12s %-24s %10s -> %s\n", tag.c_str(), what,
                  number_text(before).c_str(), number_text(after).c_str());
    text += line;
  };
  for (const ClosedLoop::Cv& cv : loop.cvs)
    row(run.unit.cv.at(static_cast<std::size_t>(cv.cv)).tag, "variance of SP - CV",
        cv.variance_before, cv.variance_after);
  for (const ClosedLoop::Mv& mv : loop.mvs)
    row(run.unit.mv.at(static_cast<std::size_t>(mv.mv)).tag, "% of time at a limit",
        100.0 * mv.at_limit_before, 100.0 * mv.at_limit_after);
  return text;
}

}  // namespace

nlohmann::ordered_json to_json(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  Json json{{"unit", run.unit.unit},
            {"samples", diagnosis.samples},
            {"fit_samples", diagnosis.fit_samples},
            {"validation_samples", diagnosis.validation_samples},
            {"verdict", name_of(diagnosis.verdict)},
            {"reason", diagnosis.reason},
            {"headline", verdict_headline(run)},
            {"details", verdict_details(run)},
            {"findings", findings_json(run, diagnosis.findings)},
            {"validation", scores_json(run)},
            {"extended_model", "extended.yaml"},
            {"refused", findings_json(run, diagnosis.refused)},
            {"small", findings_json(run, diagnosis.small)},
            {"unexplained", unexplained_json(run)},
            {"suspect", suspect_json(run)},
            {"inputs", inputs_json(run)},
            {"channels", channels_json(run)},
            {"closed_loop", closed_loop_json(run)}};
  if (run.other_row != OtherRow::kNone) json["matches_with_cvs"] = other_row_name(run.other_row);
  if (run.condensing.any()) json["condensed"] = condensing_json(run.condensing);
  if (run.time_chosen || !run.recording.borders.empty()) json["used"] = used_json(run.recording);
  if (const Json notes = data_notes(run); !notes.empty()) json["data"] = notes;
  json["made_by"] = {{"program", run.program},
                     {"command", run.command_line},
                     {"config", run.config_file},
                     {"data", run.data_file},
                     {"validation_data", tag_or_null(run.validation_file)},
                     {"fit_share", run.fit_share},
                     {"seed", run.seed},
                     {"notices", run.notices}};
  return json;
}

std::string to_text(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  std::string text = verdict_sentence(run) + '\n';
  int number = 0;
  for (const Finding& finding : diagnosis.findings)
    text += "\n  " + std::to_string(++number) + ". " + finding_text(run, finding);
  for (const Finding& finding : diagnosis.small)
    text += "\n  too small to matter: " + explain(run, finding) + '\n';
  for (const Finding& finding : diagnosis.refused)
    text += "\n  refused: " + names_of(run).subject(finding.subject) + ": " +
            (finding.refused.empty() ? "its repair did not carry over" : finding.refused) + '\n';
  if (diagnosis.suspect && diagnosis.verdict == DiagnosisVerdict::kUndetermined)
    text += "\n  suspect: " + names_of(run).subject(diagnosis.suspect->subject) +
            ", which the calibrated test of the channels does not confirm\n";
  for (const Unexplained& left : diagnosis.unexplained)
    text += "\n  " + unexplained_text(run, left) + '\n';
  for (const std::string& moved : moved_levels(run)) text += "\n  " + moved + '\n';
  if (!diagnosis.scores.empty()) text += score_table(run);
  if (run.closed_loop) text += loop_table(run);
  return text;
}

}  // namespace mpm::report
