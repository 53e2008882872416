#include "daemon/report/page/plot_json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace mpm::report {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const char* name_of(Role role) {
  switch (role) {
    case Role::kMeasured:
      return "measured";
    case Role::kBefore:
      return "before";
    case Role::kAfter:
      break;
  }
  return "after";
}

/// Numbers that are read back as the text says; no minus before 0.
Json as_written(const char* format, int digits, double value) {
  if (!std::isfinite(value)) return nullptr;
  char text[400];
  std::snprintf(text, sizeof text, format, digits, value);
  const double written = std::strtod(text, nullptr);
  return written == 0.0 ? 0.0 : written;
}

struct ValueRange {
  double low = kInfinity, high = -kInfinity;
};

ValueRange range_of(const Series& values) {
  ValueRange range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

}  // namespace

Json visible_digits(const Series& values) {
  const auto [low, high] = range_of(values);
  const double range = high > low ? high - low : std::max(1e-300, std::abs(high));
  const int decimals = std::isfinite(range)
                           ? std::clamp(3 - static_cast<int>(std::floor(std::log10(range))), 0, 300)
                           : 0;
  Json json = Json::array();
  for (const double value : values) json.push_back(as_written("%.*f", decimals, value));
  return json;
}

Json significant_digits(const Series& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(as_written("%.*g", 3, value));
  return json;
}

std::size_t thinning(std::size_t samples, std::size_t points) {
  return std::max<std::size_t>(1, (samples + points - 1) / std::max<std::size_t>(1, points));
}

Series means_of(const Series& values, std::size_t every) {
  if (every <= 1) return values;
  Series means;
  for (std::size_t start = 0; start < values.size(); start += every) {
    double sum = 0.0, known = 0.0;
    for (std::size_t i = start; i < std::min(values.size(), start + every); ++i) {
      if (!std::isfinite(values[i])) continue;
      sum += values[i];
      known += 1.0;
    }
    means.push_back(known > 0.0 ? sum / known : kNone);
  }
  return means;
}

Envelope envelope_of(const Series& values, std::size_t every) {
  Envelope envelope;
  for (std::size_t start = 0; start < values.size(); start += every) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(start);
    const auto last =
        values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), start + every));
    const ValueRange range = range_of(Series(first, last));
    envelope.low.push_back(range.low <= range.high ? range.low : kNone);
    envelope.high.push_back(range.low <= range.high ? range.high : kNone);
  }
  return envelope;
}

Plot::Plot(const std::string& title)
    : json_{{"title", title}, {"x", Json::object()}, {"y", Json::object()}} {
  json_["lines"] = Json::array();
}

Plot& Plot::note(const std::string& text) {
  json_["note"] = text;
  return *this;
}

Plot& Plot::over_time(const std::vector<Stretch>& stretches) {
  json_["x"]["clock"] = true;
  return over_span("", stretches);
}

Plot& Plot::over_span(const std::string& label, const std::vector<Stretch>& stretches) {
  Json& x = json_["x"];
  x["label"] = label;
  x["stretches"] = Json::array();
  for (const auto& [start_s, step_s, count] : stretches)
    x["stretches"].push_back({start_s, step_s, count});
  return *this;
}

Plot& Plot::over(const std::string& label, const Series& x) {
  json_["x"] = {{"label", label}, {"values", log_ ? significant_digits(x) : visible_digits(x)}};
  if (log_) json_["x"]["log"] = true;
  return *this;
}

Plot& Plot::logarithmic() {
  log_ = true;
  json_["x"]["log"] = json_["y"]["log"] = true;
  return *this;
}

Plot& Plot::y(const std::string& label) {
  json_["y"]["label"] = label;
  return *this;
}

Json& Plot::add(const std::string& name, Role role, const Series& values) {
  json_["lines"].push_back(
      {{"name", name},
       {"role", name_of(role)},
       {"values", log_ ? significant_digits(values) : visible_digits(values)}});
  return json_["lines"].back();
}

Plot& Plot::line(const std::string& name, Role role, const Series& values) {
  add(name, role, values);
  return *this;
}

Plot& Plot::dashed(const std::string& name, Role role, const Series& values) {
  add(name, role, values)["dashed"] = true;
  return *this;
}

Plot& Plot::points(const std::string& name, Role role, const Series& values) {
  add(name, role, values)["points"] = true;
  return *this;
}

Plot& Plot::band(Role role, const Series& low, const Series& high) {
  json_["bands"].push_back(
      {{"role", name_of(role)}, {"low", visible_digits(low)}, {"high", visible_digits(high)}});
  return *this;
}

Plot& Plot::path(const std::string& name, Role role, const Series& x, const Series& values) {
  add(name, role, values)["x"] = visible_digits(x);
  json_["paths"] = true;
  return *this;
}

Plot& Plot::mark(double x, const std::string& label) {
  json_["marks"].push_back({{"x", x}, {"label", label}});
  return *this;
}

Plot& Plot::unseen_from(double x) {
  json_["unseen"] = x;
  return *this;
}

Plot& Plot::group(const std::string& name) {
  json_["group"] = name;
  return *this;
}

Plot& Plot::low() {
  json_["low"] = true;
  return *this;
}

}  // namespace mpm::report
