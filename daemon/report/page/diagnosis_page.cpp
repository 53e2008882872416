#include "daemon/report/page/diagnosis_page.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/load_unit.hpp"
#include "core/identify/causes/cause.hpp"
#include "core/statistics/spectrum.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/diagnosis/data_notes.hpp"
#include "daemon/report/diagnosis/explain.hpp"
#include "daemon/report/diagnosis/extended_unit.hpp"
#include "daemon/report/diagnosis/names_of.hpp"
#include "daemon/report/page/channel_matrix.hpp"
#include "daemon/report/page/channel_numbers.hpp"
#include "daemon/report/page/control_section.hpp"
#include "daemon/report/page/finding_views.hpp"
#include "daemon/report/page/page_parts.hpp"
#include "daemon/report/page/plot_json.hpp"
#include "daemon/report/page/residual_views.hpp"
#include "daemon/report/page/series.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Eigen::Index;

constexpr std::size_t kNamed = 2;  ///< findings in the headline
constexpr std::size_t kLevels = 12;
constexpr double kOwnFeedback = 0.2;  ///< less of an input's movement from outside is a warning
constexpr double kWorthALine = 0.1;   ///< probability of a rival against the finding

/// 2 ln odds as a probability against the better one.
double probability(double worse) { return 1.0 / (1.0 + std::exp(worse / 2.0)); }

/// One sentence: what is wrong, where.
std::string sentence(const DiagnosisRun& run) {
  const std::vector<Finding>& findings = run.diagnosis.findings;
  if (run.diagnosis.verdict != DiagnosisVerdict::kMismatch || findings.empty())
    return verdict_headline(run);
  std::vector<std::string> named;
  for (std::size_t i = 0; i < std::min(kNamed, findings.size()); ++i)
    named.push_back(place_text(run, findings[i].subject) + " (" + short_text(run, findings[i]) +
                    ")");
  if (findings.size() > kNamed) named.push_back(counted(findings.size() - kNamed, "more finding"));
  return difference_headline(run) + listed(named) + ".";
}

Json warnings(const DiagnosisRun& run) {
  Json json = Json::array();
  std::vector<std::string> setpoints;
  for (const config::CvSignal& cv : run.unit.cv) setpoints.push_back(cv.setpoint);
  for (const std::string& text :
       weak_data(run.recording, setpoints, settling_rows(run, 4 * run.recording.samples())))
    json.push_back(text);
  std::vector<std::string> fed_back;
  for (const InputMovement& movement : run.diagnosis.inputs)
    if (movement.outside_share && *movement.outside_share < kOwnFeedback)
      fed_back.push_back(names_of(run).input(movement.input).tag);
  if (!fed_back.empty())
    json.push_back("Feedback: " + listed(fed_back) + (fed_back.size() == 1 ? " moves" : " move") +
                   " almost only as the controller answers the CVs; what the data say of " +
                   (fed_back.size() == 1 ? "its" : "their") + " channels is weak.");
  for (const Json& note : data_notes(run))
    json.push_back((note["compressed"].get<bool>()        ? "Compressed: "
                    : note["quantum"].get<double>() > 0.0 ? "Coarse: "
                                                          : "Seldom read: ") +
                   note["tag"].get<std::string>() + ". " + note["advice"].get<std::string>());
  return json;
}

// --- findings ---

std::string in_model_text(const DiagnosisRun& run, const Finding& finding) {
  if (!finding.repaired)
    return "Not repaired: " +
           (finding.refused.empty() ? "its repair did not carry over" : finding.refused) + ".";
  if (finding.with)
    return std::string("Repaired together with ") + other_text(finding) +
           cause_text(*finding.with) + ", " + place_text(run, *finding.with) + ".";
  return "Repaired.";
}

/// Whose error it explains.
std::string explains_text(const DiagnosisRun& run, const Finding& finding) {
  const double share = std::clamp(finding.explains, 0.0, 1.0);
  if (share < 0.005) return {};
  const int cv = finding.subject.place.cv;
  return fixed_text(100.0 * share, 0) + " % of the squared error of " +
         (cv >= 0 ? names_of(run).cv(cv).tag : "the CVs") + " on unseen data";
}

std::string rivals_text(const DiagnosisRun& run, const Finding& finding) {
  std::string text;
  std::size_t others = 0;
  for (const Rival& rival : finding.rivals) {
    if (!rival.inseparable && probability(rival.worse) < kWorthALine) {
      ++others;
      continue;
    }
    text += (text.empty() ? "" : "; ") + cause_text(rival.subject) + ", " +
            place_text(run, rival.subject);
    if (rival.inseparable) text += " (the data do not decide)";
  }
  if (text.empty()) return "nothing comes near";
  if (others > 0) text += "; " + counted(others, "other") + " less likely";
  return text;
}

/// Coefficients of a curve say nothing without it: the picture does.
bool is_coefficient(const Finding& finding, const Parameter& parameter) {
  return finding.subject.cause->kind() == std::string("polynomial") &&
         parameter.quantity->unit == Unit::kNone;
}

/// One number alone stands in the sentence.
Json numbers_of(const DiagnosisRun& run, const Finding& finding) {
  Json json = Json::array();
  if (finding.parameters.size() < 2) return json;
  for (const Parameter& parameter : finding.parameters) {
    if (is_coefficient(finding, parameter)) continue;
    const ParameterText said = parameter_text(run, finding, parameter);
    json.push_back({said.name, said.value, said.interval});
  }
  return json;
}

/// What the finding means; when it began stands beside it, in the page's own words.
std::string meaning(const DiagnosisRun& run, const Finding& finding) {
  const std::string name = finding.subject.cause->name().text;
  if (finding.parameters.size() > 1 && (name == "dynamics" || name == "unmodelled_input"))
    return {};  // its numbers say it all
  Finding timeless = finding;
  timeless.onset_s.reset();
  return explain(run, timeless);
}

Json finding_json(const DiagnosisRun& run, const Finding& finding, const Clock& clock,
                  const std::vector<ChannelNumbers>& channels) {
  Json json{{"title", finding.subject.cause->name().title},
            {"place", place_text(run, finding.subject)},
            {"in_model", finding.repaired},
            {"text", meaning(run, finding)},
            {"numbers", numbers_of(run, finding)}};
  json["facts"] = facts({{"This cause", likelihood(finding.confidence)},
                         {"Explains", explains_text(run, finding)},
                         {"Since", finding.onset_s ? clock.at(*finding.onset_s) : ""},
                         {"Model", in_model_text(run, finding)},
                         {"Or else", rivals_text(run, finding)}});
  json["plots"] = pictures(run, finding, channels);
  return json;
}

Json refused_json(const DiagnosisRun& run) {
  Json json = Json::array();
  const auto named = [&](const Finding& finding) {
    const std::string cause = cause_text(finding.subject), text = short_text(run, finding);
    return place_text(run, finding.subject) + ", " +
           (text.rfind(cause, 0) == 0 ? text : cause + " (" + text + ")") + ": ";
  };
  for (const Finding& finding : run.diagnosis.refused)
    json.push_back(named(finding) +
                   (finding.refused.empty() ? "its repair did not carry over to unseen data"
                                            : finding.refused) +
                   ".");
  for (const Finding& finding : run.diagnosis.small)
    json.push_back(named(finding) + "too small to matter.");
  if (run.diagnosis.suspect)
    json.push_back(
        named(*run.diagnosis.suspect) +
        "would explain most, and the calibrated test of the channels does not confirm it.");
  return json;
}

// --- tables ---

Json numbers_table(const DiagnosisRun& run, const std::vector<ChannelNumbers>& channels) {
  const config::UnitConfig unit = extended_unit(run.unit, run.diagnosis);
  Json json = numbers_json(channels, unit);
  std::ostringstream yaml;
  config::print_model_section(unit, yaml);
  json["yaml"] = yaml.str();
  return json;
}

/// Error of the free run on what no fit has seen.
Json errors_json(const DiagnosisRun& run) {
  Json json = Json::array();
  for (std::size_t cv = 0; cv < run.diagnosis.scores.size(); ++cv) {
    const CvScore& score = run.diagnosis.scores[cv];
    const std::string& unit = run.unit.cv[cv].unit;
    std::string less = interval_text(100.0 * score.gain_low, 100.0 * score.gain_high, 2) + " %";
    if (less.front() == '-') less.replace(0, 1, "\u2212");  // as all numbers of the page
    if (score.gain_low == score.gain_high) less = "unchanged";
    if (score.refused) less = "tried, refused";
    if (!score.judged) less = "not judged";
    const auto fit = [](double value) {  // of one that is off by more than the CV moves, no number
      return value < 0.0 ? std::string("< 0 %") : fixed_text(value, 0) + " %";
    };
    json.push_back({run.unit.cv[cv].tag, rounded(score.rmse_before, unit),
                    rounded(score.rmse_after, unit), less, fit(score.fit_before),
                    fit(score.fit_after)});
  }
  return json;
}

Json closed_loop_json(const DiagnosisRun& run) {
  if (!run.closed_loop) return nullptr;
  const ClosedLoop& loop = *run.closed_loop;
  std::string text = "The simulator's controller on the plant of scenario " + loop.scenario +
                     ", with the unit file's model and with the extended one, over the same " +
                     counted(loop.seeds.size(), "run") + " of " +
                     counted(static_cast<std::uint64_t>(loop.samples), "sample") + ".";
  if (!loop.inputs_left_out.empty())
    text += " Without " + listed(loop.inputs_left_out) +
            ", which the simulated plant does not measure for its controller.";
  Json json{{"text", text}, {"rows", Json::array()}};
  for (const ClosedLoop::Cv& cv : loop.cvs) {
    const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv.cv));
    json["rows"].push_back({signal.tag, "s.d. of set-point \u2212 CV",
                            rounded(std::sqrt(cv.variance_before), signal.unit),
                            rounded(std::sqrt(cv.variance_after), signal.unit)});
  }
  for (const ClosedLoop::Mv& mv : loop.mvs)
    json["rows"].push_back({run.unit.mv.at(static_cast<std::size_t>(mv.mv)).tag, "time at a limit",
                            rounded(100.0 * mv.at_limit_before) + " %",
                            rounded(100.0 * mv.at_limit_after) + " %"});
  return json;
}

// --- the whole record ---

bool concerns(const Diagnosis& diagnosis, int cv) {
  const auto here = [cv](const auto& each) {
    return each.subject.place.cv == cv || each.subject.place.cv < 0;
  };
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(), here) ||
         std::any_of(diagnosis.refused.begin(), diagnosis.refused.end(), here) ||
         std::any_of(diagnosis.unexplained.begin(), diagnosis.unexplained.end(), here);
}

/// A recording as it is drawn: all of it on one axis.
struct Record {
  std::string name;
  Simulated data;
  Track track;
  Index unseen_from;  ///< past the end: the fit has seen all
};

std::vector<Record> records(const DiagnosisRun& run) {
  const Index cut = run.validation || run.diagnosis.fit_samples == 0 ? run.recording.samples()
                                                                     : run.diagnosis.fit_samples;
  const std::size_t lines =
      7 * run.unit.cv.size() + 3 * static_cast<std::size_t>(run.diagnosis.extended.input_count);
  const std::size_t parts = run.validation ? 2 : 1;
  const std::size_t points =
      std::clamp<std::size_t>(kAllValues / (lines * parts), 100, kMostPoints);
  std::vector<Record> result;
  const auto add = [&](const std::string& name, const Simulated& data, Index unseen_from) {
    result.push_back(
        {name, data, Track(data.recording, runs_of(data.recording), points), unseen_from});
  };
  add(run.validation ? "fitted" : "", fitted(run), cut);
  if (run.validation) add("unseen", unseen(run), 0);
  return result;
}

std::string suffix(const Record& record) {
  return record.name.empty() ? "" : " (" + record.name + ")";
}

Json record_plots(const DiagnosisRun& run, const Record& record, int cv) {
  const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
  const CvSeries series = cv_rows(record.data, cv, {0, record.data.recording.samples()});
  const bool same = run.diagnosis.findings.empty();
  Plot values(signal.tag + suffix(record)), errors("Error of the simulation" + suffix(record));
  for (Plot* plot : {&values, &errors}) {
    record.track.under(*plot);
    plot->group("record" + record.name);
    if (record.unseen_from < record.data.recording.samples())
      plot->unseen_from(record.track.at(record.unseen_from));
    for (const Finding& finding : run.diagnosis.findings)
      if (finding.onset_s && finding.subject.place.cv == cv)
        plot->mark(*finding.onset_s, short_text(run, finding));
  }
  values.y(axis_text(signal.tag, signal.unit));
  record.track.draw(values, "measured", Role::kMeasured, series.measured);
  record.track.draw(values, "simulated", Role::kBefore, series.before);
  if (!same) record.track.draw(values, "extended", Role::kAfter, series.after);
  errors.y(axis_text("measured \u2212 simulated", signal.unit)).low();
  record.track.draw(errors, "simulated", Role::kBefore, series.residual_before);
  if (!same) record.track.draw(errors, "extended", Role::kAfter, series.residual_after);
  return Json::array({values.json(), errors.json()});
}

void drop(Series& values, Index rows) {
  values.erase(values.begin(), values.begin() + std::min<std::ptrdiff_t>(rows, std::ssize(values)));
}

Json spectrum_plot(const config::CvSignal& signal, const CvSeries& series, double sample_time_s,
                   bool same) {
  const Spectrum measured = welch(series.measured, sample_time_s);
  if (measured.frequency.empty()) return Json::array();
  Plot plot("Over frequency");
  plot.note("spectrum of the error, beside that of " + signal.tag).logarithmic();
  plot.over("frequency, 1/s", measured.frequency)
      .y("(" + (signal.unit.empty() ? signal.tag : signal.unit) + ")\u00b2 s");
  plot.line(signal.tag, Role::kMeasured, measured.density);
  plot.line("error, simulated", Role::kBefore,
            welch(series.residual_before, sample_time_s).density);
  if (!same)
    plot.line("error, extended", Role::kAfter, welch(series.residual_after, sample_time_s).density);
  return Json::array({plot.json()});
}

Json level_plot(const std::string& tag, const std::string& unit, const Series& level,
                const config::CvSignal& cv, const CvSeries& series, bool same) {
  const LevelBins bins = level_bins(level, kLevels);
  if (bins.level.size() < 2) return Json::array();
  const LevelView before = over_levels(bins, series.residual_before);
  const LevelView after = over_levels(bins, series.residual_after);
  Plot plot("Over " + tag);
  plot.note("RMS of the error by level; dashed: its mean");
  plot.over(axis_text(tag, unit), bins.level).y(axis_text("error", cv.unit));
  plot.line("simulated", Role::kBefore, before.rms).dashed("mean", Role::kBefore, before.mean);
  if (!same)
    plot.line("extended", Role::kAfter, after.rms).dashed("mean", Role::kAfter, after.mean);
  return Json::array({plot.json()});
}

/// Where the error is: over frequency, over the operating range, and with which input it goes.
Json error_plots(const DiagnosisRun& run, int cv) {
  const SignalNames names = names_of(run);
  const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
  const bool same = run.diagnosis.findings.empty();
  const Simulated data = run.validation ? unseen(run) : fitted(run);
  const Run all{0, data.recording.samples()};
  const Index settling = settling_rows(run, all.count);
  CvSeries series = cv_rows(data, cv, all);
  for (Series* values : {&series.measured, &series.before, &series.after, &series.residual_before,
                         &series.residual_after})
    drop(*values, settling);
  Json plots = spectrum_plot(signal, series, data.recording.sample_time_s, same);
  const auto append = [&plots](const Json& more) {
    for (const Json& each : more) plots.push_back(each);
  };
  append(level_plot(signal.tag, signal.unit, series.measured, signal, series, same));
  for (int input = 0; input < run.diagnosis.extended.input_count; ++input) {
    Series level = input_rows(run, data.recording, input, all);
    drop(level, settling);
    append(
        level_plot(names.input(input).tag, names.input(input).unit, level, signal, series, same));
  }
  const Run fit_rows{0, run.recording.samples()};
  for (int input = 0; input < run.diagnosis.extended.input_count; ++input) {
    const Series moved = input_rows(run, run.recording, input, fit_rows);
    append(lag_plot(
        run, cv, names.input(input).tag,
        Eigen::Map<const Eigen::VectorXd>(moved.data(), static_cast<Index>(moved.size()))));
  }
  return plots;
}

Json cvs_json(const DiagnosisRun& run, const std::vector<Record>& all) {
  Json json = Json::array();
  if (run.diagnosis.before.cols() == 0) return json;
  for (int cv = 0; cv < run.unit.counts().cv; ++cv) {
    const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
    Json entry{{"tag", signal.tag}, {"description", signal.description}};
    entry["plots"] = Json::array();
    for (const Record& record : all)
      for (const Json& plot : record_plots(run, record, cv)) entry["plots"].push_back(plot);
    entry["errors"] = concerns(run.diagnosis, cv) ? error_plots(run, cv) : Json::array();
    json.push_back(std::move(entry));
  }
  return json;
}

Json inputs_json(const DiagnosisRun& run, const std::vector<Record>& all) {
  const SignalNames names = names_of(run);
  Json json = Json::array();
  for (const Record& record : all)
    for (int input = 0; input < run.diagnosis.extended.input_count; ++input) {
      const SignalName& name = names.input(input);
      Plot plot(name.tag + suffix(record));
      record.track.under(plot);
      plot.group("record" + record.name).low().y(axis_text(name.tag, name.unit));
      record.track.draw(
          plot, name.tag, Role::kMeasured,
          input_rows(run, record.data.recording, input, {0, record.data.recording.samples()}));
      json.push_back(plot.json());
    }
  return json;
}

// --- how it was made ---

Json made_by(const DiagnosisRun& run, const Clock& clock) {
  const Diagnosis& diagnosis = run.diagnosis;
  std::string kept = run.validation_file;
  if (kept.empty() && diagnosis.validation_samples > 0)
    kept =
        "the last " + counted(static_cast<std::uint64_t>(diagnosis.validation_samples), "sample");
  Json json =
      facts({{"Command", run.command_line},
             {"Program", run.program},
             {"Unit file", run.config_file},
             {"Data", run.data_file + ": " + span_text(run.recording, run.condensing, clock)},
             {"Kept unseen", kept},
             {"Seed of the resampling", std::to_string(run.seed)}});
  for (const std::string& notice : run.notices) json.push_back({"Of the data", notice});
  return json;
}

}  // namespace

nlohmann::ordered_json page_data(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  const Clock clock(run.recording.start_s, run.recording.sample_time_s, run.zone);
  const std::vector<ChannelNumbers> channels = channel_numbers(run);
  const std::vector<Record> all = records(run);
  Json json{{"title", "Diagnosis of " + run.unit.unit},
            {"kicker", "Model diagnosis of " + run.unit.unit},
            {"zone", clock.zone()},
            {"verdict", name_of(diagnosis.verdict)},
            {"sentence", sentence(run)},
            {"details", verdict_details(run)},
            {"data", run.data_file + ": " + span_text(run.recording, run.condensing, clock)},
            {"warnings", warnings(run)},
            {"matrix", matrix_json(run)},
            {"numbers", numbers_table(run, channels)},
            {"views", telling_views(run)}};
  json["findings"] = Json::array();
  for (const Finding& finding : diagnosis.findings)
    json["findings"].push_back(finding_json(run, finding, clock, channels));
  json["unexplained"] = Json::array();
  for (const Unexplained& left : diagnosis.unexplained)
    json["unexplained"].push_back(unexplained_text(run, left));
  for (const std::string& moved : moved_levels(run)) json["unexplained"].push_back(moved);
  json["refused"] = refused_json(run);
  if (run.performance) json["control"] = control_section(*run.performance, run.unit.sample_time_s);
  json["errors"] = errors_json(run);
  json["closed_loop"] = closed_loop_json(run);
  json["cvs"] = cvs_json(run, all);
  json["inputs"] = inputs_json(run, all);
  json["made_by"] = made_by(run, clock);
  json["odds"] = likelihood_legend();
  return json;
}

}  // namespace mpm::report
