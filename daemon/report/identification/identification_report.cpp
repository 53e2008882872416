#include "daemon/report/identification/identification_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text/number_text.hpp"
#include "daemon/report/condensing/condensing_report.hpp"
#include "daemon/report/identification/plan_report.hpp"
#include "daemon/report/identification/reasons.hpp"
#include "daemon/report/terminal/terminal_text.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

Json interval_json(const Interval95& interval) {
  return Json::array({interval.low, interval.high});
}

std::string form_word(ChannelForm form) {
  switch (form) {
    case ChannelForm::kFirstOrder:
      return "first_order";
    case ChannelForm::kSecondOrder:
      return "second_order";
    case ChannelForm::kDamped:
      return "damped";
    case ChannelForm::kSecondOrderLead:
      return "second_order_lead";
    case ChannelForm::kThirdOrderLead:
      return "third_order_lead";
    case ChannelForm::kIntegrator:
      return "integrator";
    case ChannelForm::kIntegratorLag:
      return "integrator_lag";
  }
  return {};
}

const std::string& cv_tag(const IdentificationRun& run, int cv) {
  return run.unit.cv[static_cast<std::size_t>(cv)].tag;
}

Json channel_json(const IdentificationRun& run, const ChannelAnswer& answer) {
  Json json{{"cv", cv_tag(run, answer.cv)},
            {"mv", run.unit.input_tag(answer.input)},
            {"in_model", answer.left_out == LeftOut::kIdentified},
            {"reason", reason_word(answer.left_out)},
            {"text", reason_text(run, answer)},
            {"p_value", answer.p_value},
            {"contribution", answer.contribution},
            {"visible_gain",
             std::isfinite(answer.visible_gain) ? Json(answer.visible_gain) : Json(nullptr)}};
  if (!answer.dynamics) return json;
  const TransferFunction& tf = *answer.dynamics;
  json["form"] = form_word(answer.form);
  json["gain"] = tf.gain;
  json["time_constants"] = tf.time_constants_s;
  if (answer.pair)
    json["damped_pair"] = {{"time", answer.pair->time}, {"damping", answer.pair->damping}};
  json["lead"] = tf.lead_s;
  json["dead_time"] = tf.dead_time_s;
  json["integrating"] = tf.integrating;
  Json& interval = json["interval"];
  interval["gain"] = interval_json(answer.gain);
  interval["dead_time"] = interval_json(answer.dead_time_s);
  interval["time_constants"] = Json::array();
  for (const Interval95& each : answer.time_constants)
    interval["time_constants"].push_back(interval_json(each));
  if (answer.lead_s) interval["lead"] = interval_json(*answer.lead_s);
  if (answer.damping) interval["damping"] = interval_json(*answer.damping);
  json["step_response"] = {
      {"time", answer.step_times_s}, {"values", answer.step}, {"sd", answer.step_sd}};
  return json;
}

Json cv_json(const IdentificationRun& run, const CvAnswer& answer) {
  Json json{{"cv", cv_tag(run, answer.cv)},
            {"samples", answer.rows},
            {"fitted_by", answer.output_error ? "free_run" : "one_step"},
            {"innovation_sd", answer.innovation_sd},
            {"noise_sd", answer.noise_sd},
            {"whiteness_p_value", answer.whiteness_p_value},
            {"unseen_rmse", answer.unseen_rmse},
            {"unseen_sd", answer.unseen_spread}};
  if (answer.read_every > 0) json["read_every"] = answer.read_every;
  json["past_input_p_values"] = Json::object();
  for (std::size_t i = 0; i < answer.input_p_values.size(); ++i)
    json["past_input_p_values"][run.unit.input_tag(static_cast<int>(i))] = answer.input_p_values[i];
  return json;
}

using Row = std::array<std::string, 6>;

std::string joined_numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value);
  return text;
}

Row row_of(const IdentificationRun& run, const ChannelAnswer& answer) {
  const TransferFunction& tf = *answer.dynamics;
  std::string times = joined_numbers(tf.time_constants_s);
  if (tf.integrating) times = times.empty() ? "integrates" : "integrates, " + times;
  if (answer.pair)
    times = number_text(answer.pair->time) + ", damping " + number_text(answer.pair->damping);
  if (tf.lead_s != 0.0) times += ", lead " + number_text(tf.lead_s);
  return {cv_tag(run, answer.cv),
          run.unit.input_tag(answer.input),
          number_text(tf.gain) + "  [" + interval_text(answer.gain.low, answer.gain.high) + "]",
          times,
          number_text(tf.dead_time_s) + "  [" +
              interval_text(answer.dead_time_s.low, answer.dead_time_s.high) + "]",
          percent_text(answer.contribution)};
}

std::string table(const std::vector<Row>& rows) {
  std::array<std::size_t, 6> widths{};
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      widths[c] = std::max(widths[c], columns_of(row[c]));
  std::string text;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t c = 0; c < row.size(); ++c) line += " " + padded(row[c], widths[c] + 1);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string doubts(const IdentificationRun& run) {
  std::string text;
  for (const std::string& doubt : doubts_of_model(run)) text += wrapped(doubt, 2, kReasonWidth);
  for (const CvAnswer& answer : run.identification.cvs) {
    if (answer.rows == 0.0) continue;
    if (answer.whiteness_p_value < kSuspicious)
      text +=
          wrapped(cv_tag(run, answer.cv) + ": what the model leaves is not white (p = " +
                      number_text(answer.whiteness_p_value, 2) + "); the intervals are too narrow",
                  2, kReasonWidth);
    for (std::size_t i = 0; i < answer.input_p_values.size(); ++i)
      if (answer.input_p_values[i] < kSuspicious)
        text += wrapped(cv_tag(run, answer.cv) + ": what the model leaves goes with the past of " +
                            run.unit.input_tag(static_cast<int>(i)) +
                            " (p = " + number_text(answer.input_p_values[i], 2) +
                            "); the channel is not linear, not of so low an order, or feedback "
                            "shows through",
                        2, kReasonWidth);
  }
  return text;
}

}  // namespace

bool found_any(const IdentificationRun& run) { return !run.identification.model.channels.empty(); }

nlohmann::ordered_json to_json(const IdentificationRun& run) {
  const Identification& identification = run.identification;
  Json json{{"unit", run.unit.unit},
            {"samples", run.recording.samples()},
            {"runs", run.recording.borders.size() + 1},
            {"model", found_any(run) && !run.out_file.empty() ? Json(run.out_file) : Json(nullptr)},
            {"feedback_p_value", identification.feedback_p_value},
            {"operating_point", Json::object()}};
  for (int i = 0; i < identification.model.input_count; ++i)
    json["operating_point"][run.unit.input_tag(i)] = identification.model.input_origin(i);
  for (int j = 0; j < identification.model.cv_count; ++j)
    json["operating_point"][cv_tag(run, j)] = identification.model.output_origin(j);
  json["channels"] = Json::array();
  for (const ChannelAnswer& answer : identification.channels)
    json["channels"].push_back(channel_json(run, answer));
  json["cvs"] = Json::array();
  for (const CvAnswer& answer : identification.cvs) json["cvs"].push_back(cv_json(run, answer));
  json["inputs"] = Json::array();
  for (std::size_t i = 0; i < identification.outside_shares.size(); ++i) {
    const std::optional<double>& share = identification.outside_shares[i];
    json["inputs"].push_back({{"mv", run.unit.input_tag(static_cast<int>(i))},
                              {"outside_share", share ? Json(*share) : Json(nullptr)}});
  }
  if (run.condensing.any()) json["condensed"] = condensing_json(run.condensing);
  if (run.plan) json["plan"] = plan_json(run);
  json["made_by"] = {{"program", run.program},
                     {"command", run.command_line},
                     {"config", run.config_file},
                     {"data", run.data_file},
                     {"notices", run.notices}};
  return json;
}

std::string to_text(const IdentificationRun& run) {
  std::vector<Row> rows = {
      {"CV", "input", "gain [95 %]", "time constants, s", "dead time, s", "of the CV"}};
  std::string left_out;
  for (const ChannelAnswer& answer : run.identification.channels)
    if (answer.left_out == LeftOut::kIdentified)
      rows.push_back(row_of(run, answer));
    else
      left_out += wrapped(run.unit.input_tag(answer.input) + " -> " + cv_tag(run, answer.cv) +
                              ": " + reason_text(run, answer),
                          2, kReasonWidth);
  std::string text = run.unit.unit + ": " + counted(rows.size() - 1, "channel") + " of " +
                     std::to_string(run.identification.channels.size()) + " identified from " +
                     counted(static_cast<std::uint64_t>(run.recording.samples()), "sample") +
                     " in " + counted(run.recording.borders.size() + 1, "run") + "\n";
  if (rows.size() > 1) text += '\n' + table(rows);
  if (!left_out.empty()) text += "\nleft out:\n" + left_out;
  std::string unseen;
  for (const CvAnswer& answer : run.identification.cvs)
    if (answer.unseen_spread > 0.0)
      unseen += "  " + cv_tag(run, answer.cv) + ": " + number_text(answer.unseen_rmse) + " of " +
                number_text(answer.unseen_spread) + "\n";
  if (!unseen.empty() && found_any(run))
    text += "\nerror of the free run on the last quarter, fitted like the rest, and s.d. there:\n" +
            unseen;
  std::string seldom;
  for (const CvAnswer& answer : run.identification.cvs)
    if (answer.read_every > 0 && answer.rows > 0.0)
      seldom += "  " + cv_tag(run, answer.cv) + ": every " + std::to_string(answer.read_every) +
                " samples\n";
  if (!seldom.empty()) text += "\nread seldom, and identified by the readings:\n" + seldom;
  const std::string doubt = doubts(run);
  if (!doubt.empty()) text += "\nin doubt:\n" + doubt;
  if (run.plan) text += '\n' + plan_text(run);
  return text;
}

}  // namespace mpm::report
