#include "daemon/report/detect_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/record/reason_text.hpp"
#include "daemon/report/record_json.hpp"

namespace mpm::report {
namespace {

double seconds(std::int64_t time_ns) { return static_cast<double>(time_ns) / 1e9; }

std::string format(const char* pattern, double a, double b) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

// How large a mismatch is, in per cent of the model where it has this channel.
std::string size_of(const ChannelRecord& channel) {
  if (channel.model_gain == 0.0)
    return format("  gain off by about %.3g (CV per MV unit)", channel.effect_size, 0.0);
  const double half =
      0.5 * channel.percent_of_gain(std::abs(channel.effect_high - channel.effect_low));
  std::string text = "  gain --";
  if (channel.gain_resolved())
    text = format("  gain %+.1f +- %.1f %%", channel.percent_of_gain(channel.effect_size),
                  std::abs(half));
  if (channel.usual) {
    text += channel.time_constant_resolved()
                ? format(", time constant x%.2f", channel.time_constant_ratio, 0.0)
                : ", time constant --";
    text += channel.dead_time_resolved()
                ? format(", dead time %+.2g s", channel.dead_time_error_s, 0.0)
                : ", dead time --";
  } else {
    text += ", but not of that alone: the dynamics or the dead time differ by much";
  }
  if (!channel.material) text += "; too small to matter";
  return text;
}

std::string describe(const ChannelRecord& channel) {
  std::string text = channel.mv + " -> " + channel.cv;
  text.resize(std::max<std::size_t>(text.size(), 24), ' ');
  text.append("  ").append(to_string(channel.verdict));
  if (channel.reason != Reason::kNone)
    text += " (" + reason_text(channel.reason, channel.confounder) + ")";
  text.resize(std::max<std::size_t>(text.size(), 52), ' ');
  text += format("  p %-8.1e  statistic %-7.3g", channel.p_value, channel.statistic);
  if (channel.verdict == Verdict::kMismatch)
    text += size_of(channel);
  else if (channel.smallest_error > 0.0)
    text += format("  would show a gain error of %.0f %%", 100.0 * channel.smallest_error, 0.0);
  return text;
}

}  // namespace

bool DetectReport::mismatch() const {
  return std::any_of(channels.begin(), channels.end(), [](const ChannelRecord& channel) {
    return channel.verdict == Verdict::kMismatch;
  });
}

nlohmann::ordered_json to_json(const DetectReport& report) {
  nlohmann::ordered_json json{{"unit", report.unit},
                              {"samples", report.samples},
                              {"used_samples", report.used_samples},
                              {"missing_samples", report.missing},
                              {"out_of_order_samples", report.out_of_order},
                              {"bad_values", report.bad_values},
                              {"frozen_values", report.frozen},
                              {"clipped_values", report.clipped},
                              {"spikes", report.spikes},
                              {"channels", nlohmann::ordered_json::array()},
                              {"alarms", nlohmann::ordered_json::array()}};
  for (const files::Stretch& stretch : report.used)
    json["used"].push_back(
        {{"from", seconds(stretch.from_ns)}, {"until", seconds(stretch.until_ns)}});
  for (const ChannelRecord& channel : report.channels) {
    nlohmann::ordered_json entry = json_of(channel);
    for (const char* key : {"record", "unit", "interval", "time_ns"}) entry.erase(key);
    json["channels"].push_back(std::move(entry));
  }
  for (const AlarmRecord& alarm : report.alarms) {
    nlohmann::ordered_json entry{{"time", seconds(alarm.source_time_ns)}};
    nlohmann::ordered_json record = json_of(alarm);
    for (const char* key : {"record", "unit", "time_ns"}) record.erase(key);
    entry.update(record);
    json["alarms"].push_back(std::move(entry));
  }
  return json;
}

std::string to_text(const DetectReport& report) {
  std::string text = report.unit + ": " + std::to_string(report.samples) + " samples, " +
                     std::to_string(report.used_samples) + " used";
  if (report.missing > 0) text += ", " + std::to_string(report.missing) + " missing";
  if (report.out_of_order > 0) text += ", " + std::to_string(report.out_of_order) + " out of order";
  if (report.bad_values > 0) text += ", " + std::to_string(report.bad_values) + " bad values";
  const auto implausible = [&](std::uint64_t count, const char* what) {
    if (count > 0) text += ", " + std::to_string(count) + " of them " + what;
  };
  implausible(report.frozen, "frozen");
  implausible(report.clipped, "clipped");
  implausible(report.spikes, "spikes");
  text += '\n';
  for (const ChannelRecord& channel : report.channels) text += "  " + describe(channel) + '\n';
  for (const AlarmRecord& alarm : report.alarms)
    text += format("  %.3f s: ", seconds(alarm.source_time_ns), 0.0) + "alarm " + alarm.mv +
            " -> " + alarm.cv + " " + std::string(to_string(alarm.to)) + '\n';
  return text;
}

}  // namespace mpm::report
