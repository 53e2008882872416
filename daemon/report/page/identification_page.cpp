#include "daemon/report/page/identification_page.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/load_unit.hpp"
#include "core/identification/identify_long.hpp"
#include "core/model/linear_model.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/identification/identification_report.hpp"
#include "daemon/report/identification/plan_report.hpp"
#include "daemon/report/identification/reasons.hpp"
#include "daemon/report/page/channel_matrix.hpp"
#include "daemon/report/page/channel_numbers.hpp"
#include "daemon/report/page/page_parts.hpp"
#include "daemon/report/page/plot_json.hpp"
#include "daemon/report/page/series.hpp"
#include "daemon/report/page/telling_window.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Eigen::Index;

constexpr std::size_t kMostViews = 4;
constexpr double kTwoSided95 = 1.96;

const std::string& unit_of_input(const config::UnitConfig& unit, int input) {
  const auto i = static_cast<std::size_t>(input);
  return i < unit.mv.size() ? unit.mv[i].unit : unit.dv.at(i - unit.mv.size()).unit;
}

Index settling(const IdentificationRun& run) {
  if (!found_any(run)) return kShortestWindow;
  return LinearModel(run.identification.model).settling_samples(0.02, 20'000);
}

/// The free run of the identified model on its own data, each run at its own mean level. Unknown
/// until it has forgotten that how the plant was before is not known.
Eigen::MatrixXd simulated(const IdentificationRun& run) {
  const Recording& data = run.recording;
  const ModelSpec& spec = run.identification.model;
  Eigen::MatrixXd cvs = Eigen::MatrixXd::Constant(data.samples(), spec.cv_count, std::nan(""));
  if (spec.channels.empty()) return cvs;
  LinearModel model(spec);
  for (const Run& rows : runs_of(data)) {
    model.reset_steady(data.inputs.row(rows.first).transpose());
    const Index known = rows.first + std::min(settling(run), rows.count / 4);
    for (Index row = rows.first; row < rows.first + rows.count; ++row) {
      if (row >= known) cvs.row(row) = model.output().transpose();
      model.advance(data.inputs.row(row).transpose());
    }
    for (Index cv = 0; cv < cvs.cols(); ++cv) {
      double sum = 0.0, count = 0.0;
      for (Index row = known; row < rows.first + rows.count; ++row) {
        if (!std::isfinite(data.cvs(row, cv))) continue;
        sum += data.cvs(row, cv) - cvs(row, cv);
        count += 1.0;
      }
      if (count > 0.0) cvs.col(cv).segment(rows.first, rows.count).array() += sum / count;
    }
  }
  return cvs;
}

std::vector<int> modelled_cvs(const IdentificationRun& run) {
  std::vector<int> cvs;
  for (const ChannelSpec& channel : run.identification.model.channels)
    if (std::find(cvs.begin(), cvs.end(), channel.cv) == cvs.end()) cvs.push_back(channel.cv);
  std::sort(cvs.begin(), cvs.end());
  return cvs;
}

std::size_t found_count(const IdentificationRun& run) {
  const std::vector<ChannelAnswer>& channels = run.identification.channels;
  return static_cast<std::size_t>(std::count_if(
      channels.begin(), channels.end(),
      [](const ChannelAnswer& each) { return each.left_out == LeftOut::kIdentified; }));
}

std::string sentence(const IdentificationRun& run) {
  const std::size_t found = found_count(run), all = run.identification.channels.size();
  if (found == 0) return "Nothing could be identified of " + run.unit.unit + " from these data.";
  if (found == all)
    return "All " + counted(all, "channel") + " of " + run.unit.unit + " were identified.";
  return std::to_string(found) + " of " + counted(all, "channel") + " of " + run.unit.unit +
         (found == 1 ? " was" : " were") + " identified; the others are left out, with the reason.";
}

std::string details(const IdentificationRun& run) {
  std::string text;
  for (const CvAnswer& answer : run.identification.cvs) {
    if (!(answer.unseen_spread > 0.0)) continue;
    const config::CvSignal& cv = run.unit.cv.at(static_cast<std::size_t>(answer.cv));
    text += (text.empty() ? "On the last quarter, fitted like the rest, the free run's error is "
                          : ", ") +
            cv.tag + " " + rounded(answer.unseen_rmse, cv.unit) + " of " +
            rounded(answer.unseen_spread, cv.unit) + " s.d.";
  }
  return text;
}

/// "y1, y2"
std::string not_white(const IdentificationRun& run) {
  std::string text;
  for (const CvAnswer& answer : run.identification.cvs)
    if (answer.rows > 0.0 && answer.whiteness_p_value < kSuspicious)
      text += (text.empty() ? "" : ", ") + run.unit.cv.at(static_cast<std::size_t>(answer.cv)).tag;
  return text;
}

/// "y1 (u1, u2), y3 (u1)"
std::string left_with_inputs(const IdentificationRun& run) {
  std::string text;
  for (const CvAnswer& answer : run.identification.cvs) {
    if (answer.rows == 0.0) continue;
    std::string inputs;
    for (std::size_t i = 0; i < answer.input_p_values.size(); ++i)
      if (answer.input_p_values[i] < kSuspicious)
        inputs += (inputs.empty() ? "" : ", ") + run.unit.input_tag(static_cast<int>(i));
    if (!inputs.empty())
      text += (text.empty() ? "" : ", ") + run.unit.cv.at(static_cast<std::size_t>(answer.cv)).tag +
              " (" + inputs + ")";
  }
  return text;
}

Json warnings(const IdentificationRun& run) {
  Json json = Json::array();
  std::vector<std::string> setpoints;
  for (const config::CvSignal& cv : run.unit.cv) setpoints.push_back(cv.setpoint);
  for (const std::string& text : weak_data(run.recording, setpoints, settling(run)))
    json.push_back(text);
  const auto doubt = [&](const std::string& where, const char* what) {
    if (!where.empty()) json.push_back("In doubt: " + where + ". " + what);
  };
  for (const std::string& text : doubts_of_model(run)) json.push_back("In doubt: " + text + ".");
  doubt(not_white(run), "What the model leaves there is not white: the intervals are too narrow.");
  doubt(
      left_with_inputs(run),
      "What the model leaves there goes with the past of these inputs: the channel is not linear, "
      "not of so low an order, or feedback shows through.");
  return json;
}

/// Measured and free run where the CV is moved most.
Json views(const IdentificationRun& run, const Eigen::MatrixXd& free_run) {
  Json json = Json::array();
  const Index length = std::max(kShortestWindow, 2 * settling(run));
  for (const int cv : modelled_cvs(run)) {
    if (json.size() == kMostViews) break;
    const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
    const Run all{0, run.recording.samples()};
    const Series measured = rows_of(run.recording.cvs, cv, all);
    const Series simulated = rows_of(free_run, cv, all);
    Series moved(simulated.size());
    double sum = 0.0, count = 0.0;
    for (const double value : simulated)
      if (std::isfinite(value)) {
        sum += value;
        count += 1.0;
      }
    for (std::size_t i = 0; i < moved.size(); ++i)
      moved[i] = (simulated[i] - sum / count) * (simulated[i] - sum / count);
    const Run rows = telling_window(moved, runs_of(run.recording), length, {});
    const Track track(run.recording, {rows}, kWindowPoints);
    Plot plot("");
    track.under(plot);
    plot.y(axis_text(signal.tag, signal.unit));
    track.draw(plot, "measured", Role::kMeasured, measured);
    track.draw(plot, "identified", Role::kAfter, simulated);
    json.push_back({{"title", signal.tag}, {"plots", {plot.json()}}});
  }
  return json;
}

/// A channel that was identified: its step response with the band that the data allow.
Json channel_json(const IdentificationRun& run, const ChannelAnswer& answer,
                  const std::vector<ChannelNumbers>& channels) {
  const config::CvSignal& cv = run.unit.cv.at(static_cast<std::size_t>(answer.cv));
  const std::string& input = run.unit.input_tag(answer.input);
  const std::string& per = unit_of_input(run.unit, answer.input);
  const auto numbers =
      std::find_if(channels.begin(), channels.end(), [&](const ChannelNumbers& each) {
        return each.cv == answer.cv && each.input == answer.input;
      });
  Plot plot(input + " \u2192 " + cv.tag);
  const double step_s =
      answer.step_times_s.size() > 1 ? answer.step_times_s[1] - answer.step_times_s[0] : 1.0;
  const double first_s = answer.step_times_s.empty() ? 0.0 : answer.step_times_s.front();
  plot.over_span("after the step", {{first_s, step_s, answer.step.size()}});
  plot.y(cv.unit.empty() ? cv.tag : cv.unit + (per.empty() ? "" : " per " + per));
  Series low, high;
  for (std::size_t i = 0; i < answer.step.size(); ++i) {
    const double reach = i < answer.step_sd.size() ? kTwoSided95 * answer.step_sd[i] : 0.0;
    low.push_back(answer.step[i] - reach);
    high.push_back(answer.step[i] + reach);
  }
  plot.band(Role::kAfter, low, high);
  const bool had = numbers != channels.end() && std::isfinite(numbers->gain.old_value);
  if (had) {
    LinearModel model(run.unit.model);
    const auto length =
        static_cast<int>(std::ceil((first_s + step_s * static_cast<double>(answer.step.size())) /
                                   run.unit.sample_time_s)) +
        1;
    const Eigen::VectorXd impulse = model.impulse_response(answer.cv, answer.input, length);
    Series before;
    double level = 0.0;
    Index row = 0;
    for (std::size_t i = 0; i < answer.step.size(); ++i) {
      const double at = answer.step_times_s[i] / run.unit.sample_time_s;
      for (; row < impulse.size() && static_cast<double>(row) <= at + 1e-9; ++row)
        level += impulse(row);
      before.push_back(level);
    }
    plot.line("unit file", Role::kBefore, before);
  }
  plot.line("identified", Role::kAfter, answer.step);
  return plot.json();
}

Json left_out(const IdentificationRun& run) {
  Json json = Json::array();
  for (const ChannelAnswer& answer : run.identification.channels)
    if (answer.left_out != LeftOut::kIdentified)
      json.push_back(run.unit.input_tag(answer.input) + " \u2192 " +
                     run.unit.cv.at(static_cast<std::size_t>(answer.cv)).tag + ": " +
                     reason_text(run, answer) + ".");
  return json;
}

Json numbers_table(const IdentificationRun& run, const std::vector<ChannelNumbers>& channels) {
  Json json = numbers_json(channels, run.unit);
  config::UnitConfig unit = run.unit;
  unit.model = model_at(run.identification, unit.sample_time_s);
  std::ostringstream yaml;
  if (found_any(run)) config::print_model_section(unit, yaml);
  json["yaml"] = yaml.str();
  return json;
}

Json record(const IdentificationRun& run, const Eigen::MatrixXd& free_run, Json& inputs) {
  const std::size_t lines = 4 * run.unit.cv.size() + 3 * run.unit.input_tags().size();
  const Track track(
      run.recording, runs_of(run.recording),
      std::clamp<std::size_t>(kAllValues / std::max<std::size_t>(1, lines), 100, kMostPoints));
  const Run all{0, run.recording.samples()};
  Json cvs = Json::array();
  const std::vector<int> modelled = modelled_cvs(run);
  for (int cv = 0; cv < run.unit.counts().cv; ++cv) {
    const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
    Plot plot(signal.tag);
    track.under(plot);
    plot.group("record").y(axis_text(signal.tag, signal.unit));
    track.draw(plot, "measured", Role::kMeasured, rows_of(run.recording.cvs, cv, all));
    if (std::find(modelled.begin(), modelled.end(), cv) != modelled.end())
      track.draw(plot, "identified", Role::kAfter, rows_of(free_run, cv, all));
    cvs.push_back({{"tag", signal.tag},
                   {"description", signal.description},
                   {"plots", {plot.json()}},
                   {"errors", Json::array()}});
  }
  for (int input = 0; input < run.unit.counts().inputs(); ++input) {
    const std::string& tag = run.unit.input_tag(input);
    Plot plot(tag);
    track.under(plot);
    plot.group("record").low().y(axis_text(tag, unit_of_input(run.unit, input)));
    track.draw(plot, tag, Role::kMeasured, rows_of(run.recording.inputs, input, all));
    inputs.push_back(plot.json());
  }
  return cvs;
}

}  // namespace

nlohmann::ordered_json page_data(const IdentificationRun& run) {
  const Clock clock(run.recording.start_s, run.recording.sample_time_s, run.zone);
  const std::vector<ChannelNumbers> channels = channel_numbers(run);
  const Eigen::MatrixXd free_run = simulated(run);
  Json json{{"title", "Model of " + run.unit.unit},
            {"kicker", "Model of " + run.unit.unit + ", identified from data"},
            {"zone", clock.zone()},
            {"verdict", found_any(run) ? "identified" : "undetermined"},
            {"sentence", sentence(run)},
            {"details", details(run)},
            {"data", run.data_file + ": " + span_text(run.recording, run.condensing, clock)},
            {"warnings", warnings(run)},
            {"matrix", matrix_json(run)},
            {"numbers", numbers_table(run, channels)},
            {"views", views(run, free_run)}};
  json["responses"] = Json::array();
  for (const ChannelAnswer& answer : run.identification.channels)
    if (answer.left_out == LeftOut::kIdentified && !answer.step.empty())
      json["responses"].push_back(channel_json(run, answer, channels));
  json["refused"] = left_out(run);
  if (run.plan) json["plan"] = plan_text(run);
  json["inputs"] = Json::array();
  json["cvs"] = record(run, free_run, json["inputs"]);
  json["made_by"] = facts({{"Command", run.command_line},
                           {"Program", run.program},
                           {"Unit file", run.config_file},
                           {"Data", run.data_file},
                           {"New unit file", run.out_file}});
  for (const std::string& notice : run.notices) json["made_by"].push_back({"Of the data", notice});
  return json;
}

}  // namespace mpm::report
