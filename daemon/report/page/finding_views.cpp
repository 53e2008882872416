#include "daemon/report/page/finding_views.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "core/identify/causes/cause.hpp"
#include "core/model/linear_model.hpp"
#include "core/statistics/cross_correlation.hpp"
#include "daemon/report/diagnosis/names_of.hpp"
#include "daemon/report/page/channel_matrix.hpp"
#include "daemon/report/page/model_views.hpp"
#include "daemon/report/page/residual_views.hpp"
#include "daemon/report/page/series.hpp"
#include "daemon/report/page/telling_window.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Eigen::Index;

constexpr double kSettled = 0.02;  ///< of a step response is still to come
constexpr std::size_t kRecordPoints = 600;
constexpr std::size_t kMostUnnamed = 3;  ///< views where there is no finding
constexpr std::size_t kMostResponses = 4;
constexpr Index kValveWindows = 4;   ///< a valve plot is so much longer: it shows turns
constexpr std::size_t kBlocks = 60;  ///< of noise over time
constexpr int kLongestLag = 300, kShortestLag = 30;
constexpr int kLagGroups = 30;  ///< of positive lags

const char* const kMeasured = "measured";
const char* const kBefore = "simulated";
const char* const kAfter = "extended";

bool is_name(const Finding& finding, std::string_view name) {
  return finding.subject.cause->name().text == name;
}

/// Whether another finding is about this CV alone.
bool has_its_own(const DiagnosisRun& run, int cv) {
  const std::vector<Finding>& findings = run.diagnosis.findings;
  return std::any_of(findings.begin(), findings.end(),
                     [cv](const Finding& each) { return each.subject.place.cv == cv; });
}

/// The CV that shows it: its own; else, first among those that show nothing else, the one whose
/// error is taken away most.
int shown_cv(const DiagnosisRun& run, const Finding& finding) {
  if (finding.subject.place.cv >= 0) return finding.subject.place.cv;
  const std::vector<CvScore>& scores = run.diagnosis.scores;
  int best = 0;
  double most = 0.0;
  for (std::size_t cv = 0; cv < scores.size(); ++cv) {
    double gain =
        scores[cv].rmse_before > 0.0 ? 1.0 - scores[cv].rmse_after / scores[cv].rmse_before : 0.0;
    if (!has_its_own(run, static_cast<int>(cv))) gain += 1.0;
    if (gain > most) {
      most = gain;
      best = static_cast<int>(cv);
    }
  }
  return best;
}

/// The signal that acts; nothing where none does.
std::optional<Series> acting(const DiagnosisRun& run, const Finding& finding, const Run& rows) {
  const Place& place = finding.subject.place;
  if (place.aux >= 0) return rows_of(run.recording.aux, place.aux, rows);
  if (place.input >= 0) return rows_of(run.recording.inputs, place.input, rows);
  return std::nullopt;
}

/// How far each value is from the usual, squared, in s.d.
Series movement(const Series& values) {
  double sum = 0.0, squares = 0.0, known = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    known += 1.0;
  }
  const double mean = known > 0.0 ? sum / known : 0.0;
  const double variance = known > 0.0 ? squares / known - mean * mean : 0.0;
  Series result(values.size(), 1.0);
  if (variance > 0.0)
    for (std::size_t i = 0; i < values.size(); ++i)
      result[i] = std::isfinite(values[i]) ? (values[i] - mean) * (values[i] - mean) / variance : 0;
  return result;
}

Run all_rows(const Recording& recording) { return {0, recording.samples()}; }

/// How much each row tells: the error that the extended model takes away (all of it where the model
/// holds no repair), while what acts is moved.
Series telling_weights(const DiagnosisRun& run, int cv, const Finding* finding) {
  const Run all = all_rows(run.recording);
  const CvSeries series = cv_rows(fitted(run), cv, all);
  Series weights(series.measured.size());
  const bool repaired = finding != nullptr && finding->repaired;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double before = series.residual_before[i], after = series.residual_after[i];
    weights[i] = before * before - (repaired ? after * after : 0.0);
  }
  if (finding == nullptr) return weights;
  if (const std::optional<Series> input = acting(run, *finding, all)) {
    const Series moved = movement(*input);
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] *= moved[i];
  }
  return weights;
}

/// First row at or after a moment on the clock of the data; -1: none.
Index row_at(const Recording& recording, double time_s) {
  for (const Run& run : runs_of(recording))
    for (Index row = run.first; row < run.first + run.count; ++row)
      if (clock_at(recording, row) >= time_s) return row;
  return -1;
}

Index window_length(const DiagnosisRun& run) {
  const Index settling = settling_rows(run, run.recording.samples());
  return std::max(kShortestWindow, 2 * settling);
}

/// First row that no fit has seen; the recording's end where it was all fitted.
Index first_unseen(const DiagnosisRun& run) {
  const bool cut = !run.validation && run.diagnosis.fit_samples > 0;
  return cut ? run.diagnosis.fit_samples : run.recording.samples();
}

void mark_onset(const DiagnosisRun& run, const Finding& finding, const Run& rows, Plot& plot) {
  if (!finding.onset_s) return;
  const double from = clock_at(run.recording, rows.first);
  const double until = clock_at(run.recording, rows.first + rows.count - 1);
  if (*finding.onset_s > from && *finding.onset_s < until) plot.mark(*finding.onset_s, "begins");
}

Json window_plots(const DiagnosisRun& run, int cv, const Finding* finding, const Run& rows,
                  const std::string& group) {
  const SignalNames names = names_of(run);
  const Track track(run.recording, {rows}, kWindowPoints);
  const Simulated data = fitted(run);
  const Run all = all_rows(run.recording);
  const CvSeries series = cv_rows(data, cv, all);
  Plot plot("");
  track.under(plot);
  plot.y(axis_text(names.cv(cv).tag, names.cv(cv).unit)).group(group);
  track.draw(plot, kMeasured, Role::kMeasured, series.measured);
  track.draw(plot, kBefore, Role::kBefore, series.before);
  if (finding != nullptr && run.diagnosis.after.cols() > cv)
    track.draw(plot, kAfter, Role::kAfter, series.after);
  const Index unseen = first_unseen(run);
  if (unseen < rows.first + rows.count) plot.unseen_from(track.at(std::max(unseen, rows.first)));
  if (finding != nullptr) mark_onset(run, *finding, rows, plot);
  Json plots = Json::array({plot.json()});
  const std::optional<Series> input =
      finding == nullptr ? std::nullopt : acting(run, *finding, all);
  if (!input) return plots;
  const SignalName& name = names.source(finding->subject.place);
  Plot moved("");
  track.under(moved);
  moved.y(axis_text(name.tag, name.unit)).group(group).low();
  track.draw(moved, name.tag, Role::kMeasured, *input);
  plots.push_back(moved.json());
  return plots;
}

// --- pictures ---

Plot step_plot(const DiagnosisRun& run, const ChannelNumbers& channel) {
  const SignalNames names = names_of(run);
  const StepView view = step_view(run, channel);
  const SignalName &input = names.input(channel.input), &cv = names.cv(channel.cv);
  Plot plot(input.tag + " \u2192 " + cv.tag + ", step response");
  plot.note("step of " + rounded(view.size, input.unit));
  plot.over_span("after the step", {{0.0, view.spacing_s, view.after.size()}});
  plot.y(cv.unit.empty() ? cv.tag : cv.unit + (input.unit.empty() ? "" : " per " + input.unit));
  if (!view.low.empty()) plot.band(Role::kAfter, view.low, view.high);
  const bool is_new = std::all_of(view.before.begin(), view.before.end(),
                                  [](double value) { return value == 0.0; });
  if (!is_new) plot.line(kBefore, Role::kBefore, view.before);
  plot.line(kAfter, Role::kAfter, view.after);
  return plot;
}

Json step_plots(const DiagnosisRun& run, const Finding& finding,
                const std::vector<ChannelNumbers>& channels) {
  const Place& place = finding.subject.place;
  int input = place.input;
  if (place.aux >= 0) {
    const std::vector<int>& taken = run.diagnosis.new_inputs;
    const auto at = std::find(taken.begin(), taken.end(), place.aux);
    if (at == taken.end()) return Json::array();
    input = run.unit.counts().inputs() + static_cast<int>(at - taken.begin());
  }
  Json plots = Json::array();
  for (const ChannelNumbers& channel : channels)
    if ((place.cv < 0 || channel.cv == place.cv) && (input < 0 || channel.input == input) &&
        plots.size() < kMostResponses)
      plots.push_back(step_plot(run, channel).json());
  return plots;
}

Json curve_plots(const DiagnosisRun& run, const Finding& finding) {
  const Place& place = finding.subject.place;
  Json plots = Json::array();
  for (const CurveView& curve : curve_views(run)) {
    const bool input = curve.input == place.input && (curve.cv == place.cv || curve.cv < 0);
    if (!input && !(place.input < 0 && curve.cv == place.cv)) continue;
    Plot plot(curve.title);
    plot.over(curve.x_label, curve.x).y(curve.y_label);
    plot.path(kBefore, Role::kBefore, curve.x, curve.before);
    plot.path(kAfter, Role::kAfter, curve.x, curve.after);
    plots.push_back(plot.json());
  }
  return plots;
}

/// OP against PV while the valve turns a few times.
Json valve_plot(const DiagnosisRun& run, const Finding& finding, const Run& rows) {
  const SignalNames names = names_of(run);
  const int cv = shown_cv(run, finding);
  const std::optional<Series> command = acting(run, finding, rows);
  if (!command) return Json::array();
  const CvSeries series = cv_rows(fitted(run), cv, rows);
  const std::size_t every = thinning(series.measured.size(), kRecordPoints);
  const Series x = means_of(*command, every);
  const SignalName &from = names.source(finding.subject.place), &to = names.cv(cv);
  Plot plot("Valve plot: " + to.tag + " over " + from.tag);
  plot.over(axis_text(from.tag, from.unit), x).y(axis_text(to.tag, to.unit));
  plot.path(kMeasured, Role::kMeasured, x, means_of(series.measured, every));
  plot.path(kBefore, Role::kBefore, x, means_of(series.before, every));
  if (finding.repaired) plot.path(kAfter, Role::kAfter, x, means_of(series.after, every));
  return Json::array({plot.json()});
}

/// What the process sees of a command that sticks or has play.
Json command_plot(const DiagnosisRun& run, const Finding& finding, const Run& rows) {
  const int input = finding.subject.place.input;
  if (input < 0 || !finding.repaired) return Json::array();
  const SignalName name = names_of(run).input(input);
  const Track track(run.recording, {rows}, kWindowPoints);
  const Series command = rows_of(run.recording.inputs, input, all_rows(run.recording));
  const Series seen =
      seen_of_command(run.diagnosis.extended, finding.subject.place.cv, input, command);
  Plot plot("What the process sees of " + name.tag);
  track.under(plot);
  plot.y(axis_text(name.tag, name.unit));
  track.draw(plot, "command", Role::kMeasured, command);
  track.draw(plot, kAfter, Role::kAfter, seen);
  return Json::array({plot.json()});
}

/// The terms that the extended model has for the finding, over the whole recording.
Series disturbance(const DiagnosisRun& run, const Finding& finding) {
  const Recording& recording = run.recording;
  const std::string_view shape = finding.subject.cause->kind();
  ModelSpec spec = run.diagnosis.extended;
  spec.output_blocks.clear();
  std::erase_if(spec.disturbances, [&](const DisturbanceTerm& term) {
    const char* name = term.shape == DisturbanceShape::kStep    ? "step"
                       : term.shape == DisturbanceShape::kDrift ? "drift"
                                                                : "periodic";
    const bool later = finding.onset_s && term.shape != DisturbanceShape::kPeriodic &&
                       std::abs(term.onset_s - *finding.onset_s) > recording.sample_time_s;
    return term.cv != finding.subject.place.cv || shape != name || later;
  });
  if (spec.disturbances.empty()) return {};
  ModelSpec without = spec;
  without.disturbances.clear();
  LinearModel with_it(spec), without_it(without);
  with_it.set_time_s(recording.start_s);
  with_it.reset();
  const Eigen::VectorXd rest = spec.input_origin.size() == spec.input_count
                                   ? spec.input_origin
                                   : Eigen::VectorXd::Zero(spec.input_count);
  Series values;
  for (Index row = 0; row < recording.samples(); ++row) {
    values.push_back(with_it.output()(finding.subject.place.cv) -
                     without_it.output()(finding.subject.place.cv));
    with_it.advance(rest);
    without_it.advance(rest);
  }
  return values;
}

bool moves(const Series& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
}

Json disturbance_plot(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names = names_of(run);
  const int cv = finding.subject.place.cv;
  const Run all = all_rows(run.recording);
  const Track track(run.recording, runs_of(run.recording), kRecordPoints);
  const CvSeries series = cv_rows(fitted(run), cv, all);
  const Series fitted_term = disturbance(run, finding);
  if (!moves(fitted_term) && !finding.onset_s) return Json::array();
  Plot plot("Disturbance of " + names.cv(cv).tag);
  track.under(plot);
  plot.y(axis_text(names.cv(cv).tag, names.cv(cv).unit));
  // Without a term in the model the residual is all that there is.
  Series left = series.residual_after;
  for (std::size_t i = 0; i < fitted_term.size(); ++i) left[i] += fitted_term[i];
  track.draw(plot, "measured \u2212 simulated", Role::kMeasured, left);
  if (!fitted_term.empty()) track.draw(plot, "disturbance", Role::kAfter, fitted_term);
  mark_onset(run, finding, all, plot);
  return Json::array({plot.json()});
}

Json noise_plot(const DiagnosisRun& run, const Finding& finding) {
  const SignalNames names = names_of(run);
  const int cv = finding.subject.place.cv;
  const Run all = all_rows(run.recording);
  const Series rest = cv_rows(fitted(run), cv, all).residual_after;
  // From row to row, so that what is slow plays no part.
  Series steps(rest.size());
  for (std::size_t i = 1; i < rest.size(); ++i) steps[i] = rest[i] - rest[i - 1];
  const std::size_t block = std::max<std::size_t>(10, rest.size() / kBlocks);
  const Series over_time = block_rms(steps, block);
  const double step_s = run.recording.sample_time_s * static_cast<double>(block);
  Plot plot("Noise of " + names.cv(cv).tag);
  plot.note("RMS of what is left from row to row, " + std::to_string(block) + " rows at a time");
  plot.over_time({{run.recording.start_s + step_s / 2.0, step_s, over_time.size()}});
  plot.y(axis_text("RMS", names.cv(cv).unit)).line("noise", Role::kMeasured, over_time);
  mark_onset(run, finding, all, plot);
  return Json::array({plot.json()});
}

/// Means of `group` neighbours. The input is white, so that they scatter by sqrt(group) less.
Series grouped(const Series& values, int group) {
  Series means;
  for (std::size_t start = 0; start < values.size(); start += static_cast<std::size_t>(group)) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(start);
    means.push_back(std::accumulate(from, from + group, 0.0) / group);
  }
  return means;
}

int longest_lag(const DiagnosisRun& run, std::size_t samples) {
  const int settling = LinearModel(run.unit.model).settling_samples(0.05);
  const int allowed = std::max(kShortestLag, static_cast<int>(samples) / 5);
  return std::min({std::max(settling, kShortestLag), kLongestLag, allowed});
}

/// Unknown while the simulations settle, at the beginning of each run.
Series settled(const DiagnosisRun& run, Series values) {
  for (const Run& each : runs_of(run.recording)) {
    const Index count = settling_rows(run, each.count);
    std::fill_n(values.begin() + each.first, count, std::nan(""));
  }
  return values;
}

void append(Json& list, const Json& more) {
  for (const Json& each : more) list.push_back(each);
}

bool remembers(const Finding& finding) {
  return is_name(finding, "stiction") || finding.subject.cause->kind() == std::string("deadband");
}

bool bends(const Finding& finding) {
  if (remembers(finding)) return false;
  return is_name(finding, "input_nonlinearity") || is_name(finding, "output_nonlinearity") ||
         is_name(finding, "state_nonlinearity");
}

/// The window of a finding: where it begins, else where most is to be seen of it.
Run window_of(const DiagnosisRun& run, int cv, const Finding* finding,
              const std::vector<Run>& taken) {
  const std::vector<Run> runs = runs_of(run.recording);
  const Index length = window_length(run);
  if (finding != nullptr && finding->onset_s) {
    const Index row = row_at(run.recording, *finding->onset_s);
    if (row > 0) return window_around(row, runs, length);
  }
  const Series weights = telling_weights(run, cv, finding);
  for (Index shorter = length; shorter >= kShortestWindow; shorter /= 2)
    if (const Run window = telling_window(weights, runs, shorter, taken); window.count > 0)
      return window;
  return telling_window(weights, runs, length, {});
}

/// CVs by the error of their simulation beside what they do, the worst first.
std::vector<int> worst_cvs(const DiagnosisRun& run) {
  std::vector<int> cvs(static_cast<std::size_t>(run.unit.counts().cv));
  std::iota(cvs.begin(), cvs.end(), 0);
  const auto fit = [&](int cv) {
    const auto i = static_cast<std::size_t>(cv);
    return i < run.diagnosis.scores.size() ? run.diagnosis.scores[i].fit_before : 0.0;
  };
  std::stable_sort(cvs.begin(), cvs.end(), [&](int a, int b) { return fit(a) < fit(b); });
  cvs.resize(std::min(cvs.size(), kMostUnnamed));
  return cvs;
}

}  // namespace

Eigen::Index settling_rows(const DiagnosisRun& run, Eigen::Index rows) {
  const int models = std::max(LinearModel(run.unit.model).settling_samples(kSettled),
                              LinearModel(run.diagnosis.extended).settling_samples(kSettled));
  return std::min<Index>(models, rows / 4);
}

Json telling_views(const DiagnosisRun& run) {
  Json views = Json::array();
  if (run.diagnosis.before.cols() == 0) return views;
  const std::vector<Finding>& findings = run.diagnosis.findings;
  std::vector<std::vector<Run>> taken(static_cast<std::size_t>(run.unit.counts().cv));
  const auto add = [&](int cv, const Finding* finding, const std::string& title) {
    std::vector<Run>& of_cv = taken[static_cast<std::size_t>(cv)];
    const Run rows = window_of(run, cv, finding, of_cv);
    of_cv.push_back(rows);
    const std::string group = "view" + std::to_string(views.size() + 1);
    views.push_back({{"title", title}, {"plots", window_plots(run, cv, finding, rows, group)}});
  };
  for (const Finding& finding : findings) {
    add(shown_cv(run, finding), &finding,
        place_text(run, finding.subject) + ": " + short_text(run, finding));
    views.back()["finding"] = views.size();
  }
  if (findings.empty())
    for (const int cv : worst_cvs(run)) add(cv, nullptr, names_of(run).cv(cv).tag);
  return views;
}

Json pictures(const DiagnosisRun& run, const Finding& finding,
              const std::vector<ChannelNumbers>& channels) {
  if (run.diagnosis.before.cols() == 0) return Json::array();
  const Place& place = finding.subject.place;
  Json plots = Json::array();
  if (is_name(finding, "output_disturbance")) return disturbance_plot(run, finding);
  if (is_name(finding, "noise")) return noise_plot(run, finding);
  if (remembers(finding)) {
    const std::vector<Run> runs = runs_of(run.recording);
    const Run window = window_of(run, shown_cv(run, finding), &finding, {});
    if (place.cv >= 0)
      append(plots, valve_plot(run, finding,
                               window_around(window.first, runs, kValveWindows * window.count)));
    append(plots, command_plot(run, finding, window));
  }
  if (bends(finding)) append(plots, curve_plots(run, finding));
  if (plots.empty() && finding.repaired) append(plots, step_plots(run, finding, channels));
  const bool late =
      finding.find(kDeadTimeError) != nullptr && !remembers(finding) && !bends(finding);
  if (place.cv >= 0 && (late || plots.empty() || is_name(finding, "unmodelled_input"))) {
    const Run all = all_rows(run.recording);
    if (const std::optional<Series> input = acting(run, finding, all))
      append(plots, lag_plot(run, place.cv, names_of(run).source(place).tag,
                             Eigen::Map<const Eigen::VectorXd>(input->data(),
                                                               static_cast<Index>(input->size()))));
  }
  return plots;
}

Json lag_plot(const DiagnosisRun& run, int cv, const std::string& tag,
              const Eigen::Ref<const Eigen::VectorXd>& input) {
  const CvSeries series = cv_rows(fitted(run), cv, all_rows(run.recording));
  const Series moved(input.begin(), input.end());
  const int longest = longest_lag(run, moved.size());
  // No group holds lags from both sides of 0: above it the input came first.
  const int group = (longest + kLagGroups - 1) / kLagGroups;
  const int last = kLagGroups * group;
  const int first = 1 - last / 3 / group * group;
  const CrossCorrelation before =
      cross_correlation(moved, settled(run, series.residual_before), first, last);
  const CrossCorrelation after =
      cross_correlation(moved, settled(run, series.residual_after), first, last);
  if (before.values.empty()) return Json::array();
  const double step_s = run.recording.sample_time_s * group;
  const double start_s = run.recording.sample_time_s * (first + 0.5 * (group - 1));
  const Series low = grouped(before.values, group);
  const double bound = before.bound / std::sqrt(group);
  Plot plot("How the error goes with " + tag);
  plot.over_span(tag + " came earlier by", {{start_s, step_s, low.size()}});
  plot.y("correlation")
      .band(Role::kMeasured, Series(low.size(), -bound), Series(low.size(), bound));
  plot.line(kBefore, Role::kBefore, low);
  const bool same = before.values == after.values || after.values.empty();
  if (!same) plot.line(kAfter, Role::kAfter, grouped(after.values, group));
  return Json::array({plot.json()});
}

}  // namespace mpm::report
