#include "tests/boiler/figures.hpp"

#include <string>

#include "daemon/report/page/series.hpp"
#include "daemon/report/page/wording.hpp"
#include "tests/boiler/thesis.hpp"

namespace mpm::boiler {
namespace {

using report::Plot;
using report::Role;
using report::Series;

constexpr std::size_t kMostPoints = 1000;
constexpr double kTwoSided95 = 1.96;

/// The plots of one figure share their axis of time.
Plot plot_over(const std::string& figure, const std::string& tag, const std::string& unit,
               std::size_t samples, std::size_t every, double sample_time_s) {
  Plot plot(tag);
  const double step_s = sample_time_s * static_cast<double>(every);
  plot.over_span("time", {{0.0, step_s, (samples + every - 1) / every}});
  plot.group(figure).low().y(unit);
  return plot;
}

std::size_t every_of(const Series& values) { return report::thinning(values.size(), kMostPoints); }

Json view(const std::string& title, Json plots) {
  return {{"title", title}, {"plots", std::move(plots)}};
}

const Json* channel_of(const Json& identified, const std::string& mv, const std::string& cv) {
  for (const Json& channel : identified["channels"])
    if (channel["mv"] == mv && channel["cv"] == cv) return &channel;
  return nullptr;
}

Json step_response(const config::UnitConfig& unit, std::size_t cv, std::size_t mv,
                   const Json& channel) {
  const std::string title = unit.mv[mv].tag + " \u2192 " + unit.cv[cv].tag;
  if (!channel["in_model"].get<bool>())
    return {{"title", title}, {"text", "Left out: " + channel["text"].get<std::string>() + "."}};
  const Json& response = channel["step_response"];
  const auto times = response["time"].get<Series>(), values = response["values"].get<Series>(),
             sd = response["sd"].get<Series>();
  Series low, high;
  for (std::size_t i = 0; i < values.size(); ++i) {
    low.push_back(values[i] - kTwoSided95 * sd[i]);
    high.push_back(values[i] + kTwoSided95 * sd[i]);
  }
  Plot plot(title);
  plot.over_span("after the step", {{times.front(), times[1] - times.front(), times.size()}});
  plot.y(unit.cv[cv].unit + " per " + unit.mv[mv].unit).band(Role::kAfter, low, high);
  plot.line("identified", Role::kAfter, values);
  if (const thesis::AxisEnd end = thesis::kStepAxis[cv][mv]) {
    plot.dashed("end of the axis", Role::kMeasured, Series(values.size(), *end));
    plot.note("figure 5.2: " + report::rounded(*end));
  }
  return plot.json();
}

}  // namespace

Json cv_figure(const std::string& title, const config::UnitConfig& unit,
               const std::vector<Drawn>& runs) {
  Json plots = Json::array();
  const Series& setpoint = runs.front().samples.setpoints.front();
  const std::size_t every = every_of(setpoint);
  for (std::size_t j = 0; j < unit.cv.size(); ++j) {
    Plot plot = plot_over(title, unit.cv[j].description, unit.cv[j].unit, setpoint.size(), every,
                          unit.sample_time_s);
    for (const auto& [name, role, samples] : runs)
      plot.line(name, role, report::means_of(samples.cvs[j], every));
    plot.dashed("set-point", Role::kMeasured,
                report::means_of(runs.front().samples.setpoints[j], every));
    if (j == 0) plot.note("dotted: set-point");
    plots.push_back(plot.json());
  }
  return view(title, std::move(plots));
}

Json mv_figure(const std::string& title, const config::UnitConfig& unit,
               const std::vector<Drawn>& runs) {
  Json plots = Json::array();
  const std::size_t samples = runs.front().samples.mvs.front().size();
  const std::size_t every = every_of(runs.front().samples.mvs.front());
  for (std::size_t i = 0; i < unit.mv.size(); ++i) {
    Plot plot = plot_over(title, unit.mv[i].description, unit.mv[i].unit, samples, every,
                          unit.sample_time_s);
    for (const auto& [name, role, run] : runs)
      plot.line(name, role, report::means_of(run.mvs[i], every));
    const SignalLimits limits = unit.mv_limits(i);
    for (const std::optional<double>& limit : {limits.low, limits.high})
      if (limit)
        plot.dashed("limit", Role::kMeasured, Series((samples + every - 1) / every, *limit));
    if (i == 0) plot.note("dotted: limits");
    plots.push_back(plot.json());
  }
  return view(title, std::move(plots));
}

Json free_run_figure(const std::string& title, const config::UnitConfig& unit,
                     const Samples& measured, const std::vector<Series>& simulated) {
  Json plots = Json::array();
  const std::size_t every = every_of(measured.cvs.front());
  for (std::size_t j = 0; j < unit.cv.size(); ++j) {
    Plot plot = plot_over(title, unit.cv[j].description, unit.cv[j].unit, measured.cvs[j].size(),
                          every, unit.sample_time_s);
    plot.line("measured", Role::kMeasured, report::means_of(measured.cvs[j], every));
    plot.line("model, free run", Role::kAfter, report::means_of(simulated[j], every));
    plots.push_back(plot.json());
  }
  return view(title, std::move(plots));
}

Json step_responses(const config::UnitConfig& unit, const Json& identified) {
  Json plots = Json::array();
  for (std::size_t cv = 0; cv < unit.cv.size(); ++cv)
    for (std::size_t mv = 0; mv < unit.mv.size(); ++mv)
      if (const Json* channel = channel_of(identified, unit.mv[mv].tag, unit.cv[cv].tag))
        plots.push_back(step_response(unit, cv, mv, *channel));
  return plots;
}

}  // namespace mpm::boiler
