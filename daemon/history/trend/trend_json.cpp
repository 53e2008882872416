#include "daemon/history/trend/trend_json.hpp"

#include "daemon/history/trend/trend_words.hpp"

namespace mpm::history {
namespace {

using Json = nlohmann::ordered_json;

double seconds(std::int64_t time_ns) { return static_cast<double>(time_ns) / 1e9; }

Json number(double value) { return known(value) ? Json(value) : Json(); }

Json interval(double low, double high) {
  return known(low) && known(high) ? Json{low, high} : Json();
}

Json json_of(const CvHead& head, const CvPeriod& cv) {
  return {{"cv", head.cv},
          {"known", cv.known},
          {"residual_rms", number(cv.residual_rms)},
          {"prediction_rms", number(cv.prediction_rms)},
          {"movement_rms", number(cv.movement_rms)},
          {"fit", number(cv.fit())}};
}

Json json_of(const ChannelHead& head, const ChannelPeriod& channel) {
  return {{"mv", head.mv},
          {"cv", head.cv},
          {"match", channel.match},
          {"mismatch", channel.mismatch},
          {"undetermined", channel.undetermined},
          {"excited", channel.excited},
          {head.modelled ? "gain_error_percent" : "effect_size", number(channel.gain_error)},
          {"interval", interval(channel.low, channel.high)}};
}

Json json_of(const Trend& trend, const Change& change, const report::MomentText& moment) {
  const std::size_t first = change.first;
  Json json{{"what", change.mv.empty() ? "prediction_error" : "gain"}};
  if (!change.mv.empty()) json["mv"] = change.mv;
  json["cv"] = change.cv;
  json["gradual"] = change.gradual;
  json["since"] = seconds(change.alarm_ns.value_or(trend.periods[first].from_ns));
  json["since_period"] = period_name(trend, first);
  json["before"] = change.before;
  json["now"] = change.now;
  json["interval"] = {change.low, change.high};
  if (change.mv.empty()) json["movement_ratio"] = change.movement_ratio;
  json["p_value"] = change.p_value;
  json["text"] = words_of(trend, change, moment);
  return json;
}

Json json_of(const Trend& trend, const Standing& standing, const report::MomentText& moment) {
  return {{"mv", standing.mv},
          {"cv", standing.cv},
          {"since", standing.since_ns ? Json(seconds(*standing.since_ns)) : Json()},
          {"text", words_of(trend, standing, moment)}};
}

}  // namespace

Json to_json(const Trend& trend, const Findings& findings, const files::TimeZone* zone) {
  const report::MomentText moment(trend.periods.back().until_ns, trend.head.sample_time_s, zone);
  Json json{{"unit", trend.head.unit},
            {"samples", trend.samples()},
            {"by", to_string(trend.step)},
            {"horizon", static_cast<double>(trend.head.horizon_samples) * trend.head.sample_time_s},
            {"periods", Json::array()},
            {"changes", Json::array()},
            {"in_alarm", Json::array()},
            {"cannot_tell", Json::array()},
            {"note", words_of_rate(trend, findings)}};
  for (std::size_t k = 0; k < trend.periods.size(); ++k) {
    const Period& period = trend.periods[k];
    Json entry{{"name", period_name(trend, k)},
               {"from", seconds(period.from_ns)},
               {"until", seconds(period.until_ns)},
               {"samples", period.samples},
               {"cvs", Json::array()},
               {"channels", Json::array()}};
    for (std::size_t j = 0; j < period.cvs.size(); ++j)
      entry["cvs"].push_back(json_of(trend.head.cvs[j], period.cvs[j]));
    for (std::size_t c = 0; c < period.channels.size(); ++c)
      entry["channels"].push_back(json_of(trend.head.channels[c], period.channels[c]));
    json["periods"].push_back(std::move(entry));
  }
  for (const Change& change : findings.changes)
    json["changes"].push_back(json_of(trend, change, moment));
  for (const Standing& standing : findings.standing)
    json["in_alarm"].push_back(json_of(trend, standing, moment));
  for (const Silence& silence : findings.silent)
    json["cannot_tell"].push_back({{"mv", silence.last.mv},
                                   {"cv", silence.last.cv},
                                   {"reason", silence.last.reason},
                                   {"text", words_of(trend, silence)}});
  return json;
}

}  // namespace mpm::history
