#include "daemon/report/page/page_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "core/model/linear_model.hpp"
#include "core/statistics/cross_correlation.hpp"
#include "core/statistics/spectrum.hpp"
#include "core/text/number_text.hpp"
#include "daemon/report/diagnosis/clock_text.hpp"
#include "daemon/report/diagnosis/diagnosis_report.hpp"
#include "daemon/report/diagnosis/names_of.hpp"
#include "daemon/report/page/model_views.hpp"
#include "daemon/report/page/residual_views.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;
using Series = std::vector<double>;

constexpr std::size_t kPoints = 4'000;       // of one series
constexpr std::size_t kAllPoints = 350'000;  // of all of them; some 8 bytes each
constexpr double kSettled = 0.02;            // of a step response is still to come
constexpr std::size_t kBlocks = 60;
constexpr std::size_t kShortestBlock = 10;
constexpr std::size_t kLevels = 12;
constexpr int kLongestLag = 300;
constexpr int kShortestLag = 30;
constexpr int kLagGroups = 30;  // of positive lags

Series column(const Eigen::MatrixXd& block, Eigen::Index index, const Run& rows) {
  if (index >= block.cols()) return {};
  const double* first = block.col(index).data() + rows.first;
  return {first, first + rows.count};
}

Series difference(const Series& a, const Series& b) {
  Series result(a.size(), std::numeric_limits<double>::quiet_NaN());
  if (a.size() != b.size()) return result;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

/// Digits beyond a ten-thousandth of the range cannot be seen and would fill the page.
Json rounded(const Series& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double range = high > low ? high - low : std::max(1e-300, std::abs(high));
  const int decimals = std::isfinite(range)
                           ? std::clamp(4 - static_cast<int>(std::floor(std::log10(range))), 0, 300)
                           : 0;
  Json json = Json::array();
  char text[400];
  for (const double value : values) {
    if (!std::isfinite(value)) {
      json.push_back(nullptr);
      continue;
    }
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    const double short_value = std::strtod(text, nullptr);
    json.push_back(short_value == 0.0 ? 0.0 : short_value);
  }
  return json;
}

/// The same to four significant digits each, for scales that are logarithmic.
Json significant(const Series& values) {
  Json json = Json::array();
  char text[40];
  for (const double value : values) {
    std::snprintf(text, sizeof text, "%.4g", value);
    json.push_back(std::isfinite(value) ? Json(std::strtod(text, nullptr)) : Json(nullptr));
  }
  return json;
}

/// Rows of a recording with both simulations of them.
struct DataSet {
  const Recording* recording;
  const Eigen::MatrixXd* before;
  const Eigen::MatrixXd* after;
  Run rows;  ///< a run's, or all of them
  std::string name;
  double boundary_s;  ///< from here on no fit has seen the data; NaN = all or nothing of it
  /// Rows until the simulations have forgotten that how the plant was before is not known.
  std::size_t settled;
  std::size_t every;
};

std::size_t settling(const DiagnosisRun& run, Eigen::Index rows) {
  const int models = std::max(LinearModel(run.unit.model).settling_samples(kSettled),
                              LinearModel(run.diagnosis.extended).settling_samples(kSettled));
  return static_cast<std::size_t>(std::min<Eigen::Index>(models, rows / 4));
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

DataSet whole(const DiagnosisRun& run) {
  return {&run.recording,
          &run.diagnosis.before,
          &run.diagnosis.after,
          {0, run.recording.samples()},
          run.data_file,
          kNone,
          settling(run, run.recording.samples()),
          1};
}

DataSet whole_validation(const DiagnosisRun& run) {
  return {&*run.validation,
          &run.diagnosis.validation_before,
          &run.diagnosis.validation_after,
          {0, run.validation->samples()},
          run.validation_file,
          kNone,
          settling(run, run.validation->samples()),
          1};
}

double clock_at(const Recording& recording, Eigen::Index row) {
  return on_clock(recording,
                  recording.start_s + static_cast<double>(row) * recording.sample_time_s);
}

/// `all` run by run, for nothing may be joined across a border. No fit has seen the rows from
/// `unseen` on.
void add_runs(const DiagnosisRun& run, const DataSet& all, const std::vector<std::string>& files,
              Eigen::Index unseen, std::vector<DataSet>& sets) {
  const std::vector<Run> runs = runs_of(*all.recording);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    DataSet set = all;
    set.rows = runs[r];
    if (runs.size() > 1) {
      set.name = "run " + std::to_string(r + 1);
      if (r < files.size()) set.name += ", " + files[r];
      set.settled = settling(run, set.rows.count);
    }
    const Eigen::Index from = std::max(unseen, set.rows.first);
    if (from < set.rows.first + set.rows.count) set.boundary_s = clock_at(*set.recording, from);
    sets.push_back(std::move(set));
  }
}

std::vector<DataSet> data_sets(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  std::vector<DataSet> sets;
  const bool cut = !run.validation && diagnosis.fit_samples > 0;
  add_runs(run, whole(run), run.run_files, cut ? diagnosis.fit_samples : run.recording.samples(),
           sets);
  if (run.validation) {
    // Of a single one the page knows by itself that no fit has seen it.
    const bool several = !run.validation->borders.empty();
    add_runs(run, whole_validation(run), run.validation_run_files,
             several ? 0 : run.validation->samples(), sets);
  }
  const std::size_t series =
      sets.size() *
      (5 * run.unit.cv.size() + static_cast<std::size_t>(diagnosis.extended.input_count));
  const std::size_t points = std::clamp<std::size_t>(kAllPoints / series, 100, kPoints);
  for (DataSet& set : sets) set.every = thinning(static_cast<std::size_t>(set.rows.count), points);
  return sets;
}

/// What a CV's plots are drawn from.
struct CvSeries {
  Series measured, before, after, residual_before, residual_after;
};

CvSeries cv_series(const DataSet& set, Eigen::Index cv) {
  CvSeries series;
  series.measured = column(set.recording->cvs, cv, set.rows);
  series.before = column(*set.before, cv, set.rows);
  series.after = column(*set.after, cv, set.rows);
  series.residual_before = difference(series.measured, series.before);
  series.residual_after = difference(series.measured, series.after);
  return series;
}

Series input_series(const DiagnosisRun& run, const DataSet& set, int input) {
  const auto own = static_cast<int>(set.recording->inputs.cols());
  if (input < own) return column(set.recording->inputs, input, set.rows);
  return column(set.recording->aux,
                run.diagnosis.new_inputs.at(static_cast<std::size_t>(input - own)), set.rows);
}

void drop(Series& values, std::size_t rows) {
  values.erase(values.begin(),
               values.begin() + static_cast<std::ptrdiff_t>(std::min(rows, values.size())));
}

/// Without the rows in which the simulations still settle; those at a border count as unknown.
CvSeries settled(const DataSet& set, CvSeries series) {
  for (Series* values : {&series.measured, &series.before, &series.after, &series.residual_before,
                         &series.residual_after}) {
    for (const Border& border : set.recording->borders) {
      const auto first =
          values->begin() + std::min<std::ptrdiff_t>(border.row, std::ssize(*values));
      std::fill(first,
                first + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(set.settled),
                                                 values->end() - first),
                kNone);
    }
    drop(*values, set.settled);
  }
  return series;
}

Json set_json(const DataSet& set) {
  return {{"name", set.name},
          {"start", clock_at(*set.recording, set.rows.first)},
          {"step", set.recording->sample_time_s},
          {"samples", set.rows.count},
          {"every", set.every},
          {"settled", set.settled},
          {"boundary", std::isfinite(set.boundary_s) ? Json(set.boundary_s) : Json(nullptr)}};
}

Json time_json(const DataSet& set, const CvSeries& series) {
  const std::size_t block = std::max(kShortestBlock, series.measured.size() / kBlocks);
  const auto thin = [&](const Series& values) { return rounded(thinned(values, set.every)); };
  return {{"measured", thin(series.measured)},
          {"before", thin(series.before)},
          {"after", thin(series.after)},
          {"residual_before", thin(series.residual_before)},
          {"residual_after", thin(series.residual_after)},
          {"block", block},
          {"rms_before", rounded(block_rms(series.residual_before, block))},
          {"rms_after", rounded(block_rms(series.residual_after, block))}};
}

Json spectrum_json(const CvSeries& series, double sample_time_s) {
  const Spectrum measured = welch(series.measured, sample_time_s);
  return {{"frequency", significant(measured.frequency)},
          {"measured", significant(measured.density)},
          {"before", significant(welch(series.residual_before, sample_time_s).density)},
          {"after", significant(welch(series.residual_after, sample_time_s).density)}};
}

Json level_json(const std::string& tag, const std::string& unit, const Series& level,
                const CvSeries& series) {
  const LevelBins bins = level_bins(level, kLevels);
  const LevelView before = over_levels(bins, series.residual_before);
  const LevelView after = over_levels(bins, series.residual_after);
  return {{"tag", tag},
          {"unit", unit},
          {"level", rounded(bins.level)},
          {"rms_before", rounded(before.rms)},
          {"rms_after", rounded(after.rms)},
          {"mean_before", rounded(before.mean)},
          {"mean_after", rounded(after.mean)}};
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

Json correlation_json(const std::string& tag, const Series& input, const CvSeries& series,
                      int longest_lag) {
  // No group holds lags from both sides of 0: above it the input came first.
  const int group = (longest_lag + kLagGroups - 1) / kLagGroups;
  const int last = kLagGroups * group;
  const int first = 1 - last / 3 / group * group;
  const CrossCorrelation before = cross_correlation(input, series.residual_before, first, last);
  const CrossCorrelation after = cross_correlation(input, series.residual_after, first, last);
  return {{"tag", tag},
          {"first_lag", first + 0.5 * (group - 1)},
          {"group", group},
          {"before", rounded(grouped(before.values, group))},
          {"after", rounded(grouped(after.values, group))},
          {"bound", before.bound / std::sqrt(group)}};
}

Json steps_json(const DiagnosisRun& run, const SignalNames& names, int cv) {
  Json json = Json::array();
  for (const StepView& view : step_views(run, cv)) {
    json.push_back({{"input", names.input(view.input).tag},
                    {"input_unit", names.input(view.input).unit},
                    {"size", number_text(view.size)},
                    {"step", view.spacing_s},
                    {"before", rounded(view.before)},
                    {"after", rounded(view.after)},
                    {"low", rounded(view.low)},
                    {"high", rounded(view.high)}});
  }
  return json;
}

/// True where a finding is about this CV, or about all of them.
bool concerns(const Diagnosis& diagnosis, int cv) {
  const auto here = [cv](const Finding& each) {
    return each.subject.place.cv == cv || each.subject.place.cv < 0;
  };
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(), here) ||
         std::any_of(diagnosis.refused.begin(), diagnosis.refused.end(), here) ||
         std::any_of(diagnosis.unexplained.begin(), diagnosis.unexplained.end(),
                     [cv](const Unexplained& each) { return each.subject.place.cv == cv; });
}

int longest_lag(const DiagnosisRun& run, std::size_t samples) {
  const int settling = LinearModel(run.unit.model).settling_samples(0.05);
  const int allowed = std::max(kShortestLag, static_cast<int>(samples) / 5);
  return std::min({std::max(settling, kShortestLag), kLongestLag, allowed});
}

Json cv_json(const DiagnosisRun& run, const std::vector<DataSet>& sets, int cv) {
  const SignalNames names = names_of(run);
  const config::CvSignal& signal = run.unit.cv.at(static_cast<std::size_t>(cv));
  const bool found = concerns(run.diagnosis, cv);
  Json json{{"tag", signal.tag},
            {"unit", signal.unit},
            {"description", signal.description},
            {"found", found},
            {"sets", Json::array()}};
  for (const DataSet& set : sets) json["sets"].push_back(time_json(set, cv_series(set, cv)));

  // The rest is drawn from the data that no fit has seen where they are a recording of their own.
  const DataSet shown = run.validation ? whole_validation(run) : whole(run);
  const CvSeries series = settled(shown, cv_series(shown, cv));
  json["spectrum"] = spectrum_json(series, shown.recording->sample_time_s);
  json["levels"] = Json::array({level_json(signal.tag, signal.unit, series.measured, series)});
  json["correlations"] = Json::array();
  const int lags = longest_lag(run, series.measured.size());
  for (int input = 0; input < run.diagnosis.extended.input_count; ++input) {
    Series values = input_series(run, shown, input);
    drop(values, shown.settled);
    json["levels"].push_back(
        level_json(names.input(input).tag, names.input(input).unit, values, series));
    json["correlations"].push_back(correlation_json(names.input(input).tag, values, series, lags));
  }
  json["steps"] = found ? steps_json(run, names, cv) : Json::array();
  return json;
}

Json inputs_json(const DiagnosisRun& run, const std::vector<DataSet>& sets) {
  const SignalNames names = names_of(run);
  Json json = Json::array();
  for (int input = 0; input < run.diagnosis.extended.input_count; ++input) {
    Json entry{{"tag", names.input(input).tag}, {"unit", names.input(input).unit}};
    entry["new"] = input >= run.unit.model.input_count;
    entry["sets"] = Json::array();
    for (const DataSet& set : sets)
      entry["sets"].push_back(rounded(thinned(input_series(run, set, input), set.every)));
    json.push_back(std::move(entry));
  }
  return json;
}

Json curves_json(const DiagnosisRun& run) {
  Json json = Json::array();
  for (const CurveView& curve : curve_views(run))
    json.push_back({{"title", curve.title},
                    {"x_label", curve.x_label},
                    {"y_label", curve.y_label},
                    {"x", rounded(curve.x)},
                    {"before", rounded(curve.before)},
                    {"after", rounded(curve.after)}});
  return json;
}

}  // namespace

nlohmann::ordered_json page_data(const DiagnosisRun& run) {
  const std::vector<DataSet> sets = data_sets(run);
  Json json{{"report", to_json(run)}};
  json["dates"] = is_date(run.recording.start_s);
  json["sets"] = Json::array();
  for (const DataSet& set : sets) json["sets"].push_back(set_json(set));
  json["inputs"] = inputs_json(run, sets);
  json["cvs"] = Json::array();
  for (int cv = 0; cv < run.unit.counts().cv; ++cv) json["cvs"].push_back(cv_json(run, sets, cv));
  json["curves"] = curves_json(run);
  return json;
}

}  // namespace mpm::report
