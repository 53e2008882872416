#include "daemon/http/unit_json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/statistics/normal.hpp"
#include "daemon/report/channel_text.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::http {
namespace {

constexpr int kTrendPoints = 60;      // of a card's small line
constexpr std::size_t kTrendEnd = 4;  // a fourth of the trend at either end makes its change

Json known(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json known(const std::optional<double>& value) { return value ? known(*value) : Json(); }

/// Mean of what is known; NaN where nothing is.
class Mean {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] double value() const {
    return count_ > 0 ? sum_ / count_ : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

/// Of the horizon of one settling time, where there is one: the errors a controller plans with.
double prediction_error(const CvPerformance& cv) {
  if (cv.prediction.empty()) return std::numeric_limits<double>::quiet_NaN();
  const HorizonError& horizon =
      cv.prediction[cv.prediction.size() > 2 ? cv.prediction.size() - 2 : cv.prediction.size() - 1];
  return horizon.movement_rms > 0.0 ? horizon.rmse / horizon.movement_rms
                                    : std::numeric_limits<double>::quiet_NaN();
}

Json trend_json(const Drawing& drawing, KpiColumn column) {
  const std::vector<Reach>& reaches = drawing.reaches[static_cast<std::size_t>(column)];
  Json times = Json::array(), values = Json::array();
  Mean begins, ends;
  const std::size_t end = std::max<std::size_t>(1, reaches.size() / kTrendEnd);
  double now = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    const auto value = static_cast<double>(reaches[i].mean);
    times.push_back(drawing.times_s[i]);
    values.push_back(known(value));
    if (i < end) begins.add(value);
    if (i + end >= reaches.size()) ends.add(value);
    if (std::isfinite(value)) now = value;
  }
  return {{"now", known(now)},
          {"change", known(ends.value() - begins.value())},
          {"times", times},
          {"values", values}};
}

Json kpi_json(const UnitStore& store, const UnitSnapshot& snapshot) {
  Mean at_limits, outside_limits, error;
  for (const MvPerformance& mv : snapshot.performance.mvs) at_limits.add(mv.at_limits);
  for (const CvPerformance& cv : snapshot.performance.cvs) {
    outside_limits.add(cv.outside_limits);
    error.add(prediction_error(cv));
  }
  const auto determined = std::count_if(
      snapshot.channels.begin(), snapshot.channels.end(),
      [](const ChannelRecord& channel) { return channel.verdict != Verdict::kUndetermined; });
  const Drawing drawing = store.draw_kpi(kTrendPoints);
  return {{"service_factor", known(snapshot.performance.service_factor)},
          {"at_limits", known(at_limits.value())},
          {"outside_limits", known(outside_limits.value())},
          {"prediction_error", known(error.value())},
          {"determined", snapshot.channels.empty()
                             ? Json()
                             : Json(static_cast<double>(determined) /
                                    static_cast<double>(snapshot.channels.size()))},
          {"samples", snapshot.performance.samples},
          {"model_accuracy", trend_json(drawing, KpiColumn::kAccuracy)},
          {"determined_trend", trend_json(drawing, KpiColumn::kDetermined)}};
}

/// Neither shelved nor suppressed nor out of service: it calls for somebody.
bool calls(const Json& alarm) {
  const Json& state = alarm.at("alarm_state");
  return state == "unacknowledged" || state == "acknowledged" || state == "returned_unacknowledged";
}

const ChannelRecord* channel_of(const UnitSnapshot& snapshot, const AlarmRecord& alarm) {
  const auto found = std::find_if(snapshot.channels.begin(), snapshot.channels.end(),
                                  [&alarm](const ChannelRecord& channel) {
                                    return channel.mv == alarm.mv && channel.cv == alarm.cv;
                                  });
  return found == snapshot.channels.end() ? nullptr : &*found;
}

Json alarm_json(const UnitStore& store, const UnitSnapshot& snapshot,
                const AlarmStateRecord& alarm) {
  Json json = report::json_of(alarm);
  const ChannelRecord* channel = channel_of(snapshot, alarm);
  if (channel == nullptr) {
    json["text"] = "";
    return json;
  }
  const report::ChannelFile file = report::channel_file(store.config(), alarm.mv, alarm.cv);
  json["text"] = channel->verdict == Verdict::kMismatch
                     ? report::mismatch_text(*channel, file)
                     : report::error_text(alarm, file.modelled ? channel : nullptr);
  json["state"] = channel_state(*channel);
  return json;
}

/// As those of channels, with neither MV nor CV.
Json controller_json(const ControllerAlarmRecord& alarm) {
  Json json = report::json_of(alarm);
  json["mv"] = json["cv"] = "";
  json["to"] = json["state"];
  json.erase("state");
  json["text"] = alarm.view.message;
  return json;
}

std::string channel_text(const config::UnitConfig& unit, const ChannelRecord& channel) {
  const report::ChannelFile file = report::channel_file(unit, channel.mv, channel.cv);
  switch (channel.verdict) {
    case Verdict::kMismatch:
      return report::mismatch_text(channel, file);
    case Verdict::kUndetermined:
      return report::undetermined_text(channel, file);
    case Verdict::kMatch:
      break;
  }
  return channel.alarm == AlarmState::kActive ? "matches by now, still in alarm" : "";
}

Json channel_json(const config::UnitConfig& unit, const ChannelRecord& channel) {
  Json json = report::json_of(channel);
  for (const char* key : {"record", "unit", "interval", "time_ns", "partial_correlations"})
    json.erase(key);
  json["modelled"] = report::channel_file(unit, channel.mv, channel.cv).modelled;
  json["state"] = channel_state(channel);
  json["text"] = channel_text(unit, channel);
  json["nonlinear_text"] = report::nonlinear_text(channel);
  return json;
}

Json limits_json(const SignalLimits& limits) {
  return {{"low", known(limits.low)}, {"high", known(limits.high)}};
}

Json input_json(const UnitStore& store, const config::InputSignal& signal, const char* kind,
                int index, const SignalLimits& limits) {
  return {{"tag", signal.tag},
          {"unit", signal.unit},
          {"description", signal.description},
          {"kind", kind},
          {"limits", limits_json(limits)},
          {"value", known(store.latest(store.columns().input(index)))}};
}

Json cv_json(const UnitStore& store, int index) {
  const auto j = static_cast<std::size_t>(index);
  const config::CvSignal& signal = store.config().cv[j];
  const FeedColumns& columns = store.columns();
  return {{"tag", signal.tag},
          {"unit", signal.unit},
          {"description", signal.description},
          {"setpoint_tag", signal.setpoint.empty() ? Json() : Json(signal.setpoint)},
          {"limits", limits_json(store.config().cv_limits(j))},
          {"measured", known(store.latest(columns.measured(index)))},
          {"prediction", known(store.latest(columns.prediction(index)))},
          {"setpoint", known(store.latest(columns.setpoint(index)))}};
}

/// Before the first look nothing is determined.
Json cells_json(const UnitSnapshot& snapshot, const config::UnitConfig& unit) {
  Json rows = Json::array();
  const auto inputs = static_cast<std::size_t>(unit.counts().inputs());
  const auto cvs = static_cast<std::size_t>(unit.counts().cv);
  for (std::size_t i = 0; i < inputs; ++i) {
    Json row = Json::array();
    for (std::size_t c = i * cvs; c < (i + 1) * cvs; ++c)
      row.push_back(c < snapshot.channels.size() ? channel_state(snapshot.channels[c])
                                                 : to_string(Verdict::kUndetermined));
    rows.push_back(std::move(row));
  }
  return rows;
}

int attention(const UnitSnapshot& snapshot, std::size_t calling) {
  if (calling > 0) return 4;
  if (snapshot.health.state == "failure") return 3;
  const bool mismatch =
      std::any_of(snapshot.channels.begin(), snapshot.channels.end(),
                  [](const ChannelRecord& each) { return channel_state(each) == "mismatch"; });
  if (mismatch || snapshot.health.state == "out_of_specification") return 2;
  return snapshot.health.state == "normal" ? 0 : 1;
}

/// What a card has room for.
Json first_calls(const Json& alarms) {
  constexpr std::size_t kMost = 3;
  Json first = Json::array();
  for (const Json& alarm : alarms) {
    if (!calls(alarm) || first.size() >= kMost) continue;
    Json call = Json::object();
    for (const char* key :
         {"mv", "cv", "text", "to", "alarm_state", "priority", "message", "time_ns"})
      if (alarm.contains(key)) call[key] = alarm[key];
    first.push_back(std::move(call));
  }
  return first;
}

/// Those of channels that call, or do not; that of the controller stands for them, and counts where
/// it is the last.
std::size_t count(const Json& alarms, bool calling) {
  std::size_t of_channels = 0, of_controller = 0;
  for (const Json& alarm : alarms)
    if (calls(alarm) == calling)
      ++(alarm["cv"].get_ref<const std::string&>().empty() ? of_controller : of_channels);
  return std::max(of_channels, of_controller);
}

std::size_t calling_alarms(const Json& alarms) { return count(alarms, true); }

}  // namespace

std::string_view channel_state(const ChannelRecord& channel) {
  const bool alarm = channel.alarm == AlarmState::kActive;
  switch (channel.verdict) {
    case Verdict::kMismatch:
      return channel.material || alarm ? "mismatch" : "watch";
    case Verdict::kMatch:
      return alarm ? "watch" : "match";
    case Verdict::kUndetermined:
      break;
  }
  return alarm ? "watch" : "undetermined";
}

Json overview_json(const UnitStore& store) {
  const std::shared_ptr<const UnitSnapshot> snapshot = store.snapshot();
  const config::UnitConfig& unit = store.config();
  const Json alarms = alarms_json(store);
  const std::size_t calling = calling_alarms(alarms);
  return {{"unit", unit.unit},
          {"snapshot", snapshot->id},
          {"speaks", snapshot->speaks},
          {"attention", attention(*snapshot, calling)},
          {"sample_time_s", unit.sample_time_s},
          {"time_ns", snapshot->health.source_time_ns},
          {"health", {{"state", snapshot->health.state}, {"detail", snapshot->health.detail}}},
          {"alarms", calling},
          {"silenced_alarms", count(alarms, false)},
          {"first_alarms", first_calls(alarms)},
          {"match", snapshot->health.matching},
          {"mismatch", snapshot->health.mismatching},
          {"undetermined", snapshot->health.undetermined},
          {"inputs", unit.input_tags()},
          {"cvs", unit.cv_tags()},
          {"matrix", cells_json(*snapshot, unit)},
          {"kpi", kpi_json(store, *snapshot)}};
}

Json unit_json(const UnitStore& store) {
  const std::shared_ptr<const UnitSnapshot> snapshot = store.snapshot();
  const config::UnitConfig& unit = store.config();
  Json inputs = Json::array(), cvs = Json::array(), channels = Json::array(),
       troubles = Json::array();
  for (std::size_t i = 0; i < unit.mv.size(); ++i)
    inputs.push_back(input_json(store, unit.mv[i], "mv", static_cast<int>(i), unit.mv_limits(i)));
  for (std::size_t i = 0; i < unit.dv.size(); ++i)
    inputs.push_back(input_json(store, unit.dv[i], "dv", static_cast<int>(unit.mv.size() + i), {}));
  for (int j = 0; j < store.columns().cvs; ++j) cvs.push_back(cv_json(store, j));
  for (const ChannelRecord& channel : snapshot->channels)
    channels.push_back(channel_json(unit, channel));
  for (const bus::Trouble& trouble : snapshot->troubles)
    troubles.push_back({{"severity", bus::to_string(trouble.severity)}, {"text", trouble.text}});
  Json alarms = alarms_json(store);
  Json health = report::json_of(snapshot->health);
  health.erase("record");
  Json performance = report::json_of(snapshot->performance);
  performance.erase("record");
  return {{"unit", unit.unit},
          {"snapshot", snapshot->id},
          {"speaks", snapshot->speaks},
          {"attention", attention(*snapshot, calling_alarms(alarms))},
          {"sample_time_s", unit.sample_time_s},
          {"time_ns", snapshot->health.source_time_ns},
          {"inputs", inputs},
          {"cvs", cvs},
          {"channels", channels},
          {"alarms", alarms},
          {"health", health},
          {"troubles", troubles},
          {"performance", performance},
          {"kpi", kpi_json(store, *snapshot)}};
}

Json alarms_json(const UnitStore& store) {
  const std::shared_ptr<const UnitSnapshot> snapshot = store.snapshot();
  std::vector<Json> standing;
  for (const AlarmStateRecord& alarm : snapshot->alarms) {
    if (alarm.view.retain) standing.push_back(alarm_json(store, *snapshot, alarm));
  }
  const ControllerAlarmRecord& controller = snapshot->controller;
  if (controller.view.retain) standing.insert(standing.begin(), controller_json(controller));
  std::stable_sort(standing.begin(), standing.end(), [](const Json& a, const Json& b) {
    return a["time_ns"].get<std::int64_t>() > b["time_ns"].get<std::int64_t>();
  });
  Json alarms = Json::array();
  for (Json& alarm : standing) alarms.push_back(std::move(alarm));
  return alarms;
}

Json correlations_json(const UnitStore& store, int cv) {
  const std::shared_ptr<const UnitSnapshot> snapshot = store.snapshot();
  const std::string& tag = store.config().cv[static_cast<std::size_t>(cv)].tag;
  Json inputs = Json::array();
  for (const ChannelRecord& channel : snapshot->channels) {
    if (channel.cv != tag) continue;
    // Of white residuals: so much chance alone leaves in 95 of 100 lags.
    const double limit =
        channel.effective_samples > 1.0
            ? std::min(1.0, kNormalTwoSided95 / std::sqrt(channel.effective_samples))
            : std::numeric_limits<double>::quiet_NaN();
    inputs.push_back({{"mv", channel.mv},
                      {"first_lag", channel.first_lag},
                      {"values", channel.partial_correlations},
                      {"limit", known(limit)},
                      {"lag", channel.lag},
                      {"partial_correlation", known(channel.partial_correlation)},
                      {"excited", channel.excited},
                      {"smallest_error", known(channel.smallest_error)},
                      {"effective_samples", known(channel.effective_samples)},
                      {"verdict", to_string(channel.verdict)},
                      {"state", channel_state(channel)},
                      {"text", channel_text(store.config(), channel)}});
  }
  return {{"unit", store.config().unit},
          {"cv", tag},
          {"sample_time_s", store.config().sample_time_s},
          {"time_ns", snapshot->health.source_time_ns},
          {"inputs", inputs}};
}

}  // namespace mpm::http
