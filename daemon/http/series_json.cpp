#include "daemon/http/series_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/signal/nanoseconds.hpp"
#include "core/statistics/normal.hpp"

namespace mpm::http {
namespace {

constexpr double kUsualSamples = 3600.0;  // shown where nobody says what
constexpr double kLatest = 9e9;           // s since 1970: what whole ns can count

/// With the digits of a float and no more: a third of the text.
Json known(float value) {
  if (!std::isfinite(value)) return {};
  constexpr std::size_t kLongest = 32;
  std::array<char, kLongest> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
  double rounded = 0.0;
  std::from_chars(text.data(), written.ptr, rounded);
  return rounded;
}

Json column_json(const std::vector<Reach>& reaches, float Reach::*part) {
  Json values = Json::array();
  for (const Reach& reach : reaches) values.push_back(known(reach.*part));
  return values;
}

Json full_json(const std::vector<Reach>& reaches) {
  return {{"mean", column_json(reaches, &Reach::mean)},
          {"min", column_json(reaches, &Reach::low)},
          {"max", column_json(reaches, &Reach::high)}};
}

std::int64_t nanoseconds(double seconds) {
  return std::llround(std::clamp(seconds, 0.0, kLatest) * kNsPerSecond * 1e-3) * 1000;
}

}  // namespace

Json series_json(const UnitStore& store, int cv, const SeriesQuery& query) {
  const config::UnitConfig& unit = store.config();
  const auto j = static_cast<std::size_t>(cv);
  const FeedColumns& columns = store.columns();
  std::vector<int> wanted{columns.measured(cv), columns.prediction(cv), columns.setpoint(cv),
                          store.residual(cv)};
  for (int i = 0; i < columns.inputs; ++i) wanted.push_back(columns.input(i));

  const auto extent = store.extent();
  Drawing drawing;
  drawing.reaches.resize(wanted.size());
  std::int64_t from = 0, until = 0;
  if (extent) {
    until = query.until_s ? nanoseconds(*query.until_s) : extent->second;
    from = query.from_s
               ? nanoseconds(*query.from_s)
               : until - nanoseconds(query.span_s.value_or(kUsualSamples * unit.sample_time_s));
    drawing = store.draw(
        from, until, std::clamp(query.points, SeriesQuery::kFewestPoints, SeriesQuery::kMostPoints),
        wanted);
  }
  constexpr std::size_t kFirstInput = 4;
  Json inputs = Json::array();
  for (int i = 0; i < columns.inputs; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const config::InputSignal& signal =
        index < unit.mv.size() ? unit.mv[index] : unit.dv[index - unit.mv.size()];
    Json input = full_json(drawing.reaches[kFirstInput + index]);
    input["tag"] = signal.tag;
    input["unit"] = signal.unit;
    inputs.push_back(std::move(input));
  }
  const ResidualBand band = store.band(cv);
  const double half = kNormalTwoSided95 * band.deviation;
  const SignalLimits limits = unit.cv_limits(j);
  return {{"unit", unit.unit},
          {"cv", unit.cv[j].tag},
          {"cv_unit", unit.cv[j].unit},
          {"first", extent ? Json(static_cast<double>(extent->first) / kNsPerSecond) : Json()},
          {"last", extent ? Json(static_cast<double>(extent->second) / kNsPerSecond) : Json()},
          {"from", static_cast<double>(from) / kNsPerSecond},
          {"until", static_cast<double>(until) / kNsPerSecond},
          {"step_s", drawing.step_s},
          {"times", drawing.times_s},
          {"measured", full_json(drawing.reaches[0])},
          {"prediction", column_json(drawing.reaches[1], &Reach::mean)},
          {"setpoint", column_json(drawing.reaches[2], &Reach::mean)},
          {"residual", full_json(drawing.reaches[3])},
          {"residual_band", band.samples >= ResidualBand::kFewest ? Json{{"low", band.mean - half},
                                                                         {"high", band.mean + half},
                                                                         {"samples", band.samples}}
                                                                  : Json()},
          {"limits",
           {{"low", limits.low ? Json(*limits.low) : Json()},
            {"high", limits.high ? Json(*limits.high) : Json()}}},
          {"inputs", inputs}};
}

}  // namespace mpm::http
