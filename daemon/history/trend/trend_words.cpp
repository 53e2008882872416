#include "daemon/history/trend/trend_words.hpp"

#include <algorithm>
#include <cmath>

#include "core/record/channel_record.hpp"
#include "core/statistics/calibration.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/history/trend/calibration.hpp"
#include "daemon/report/channel_text.hpp"

namespace mpm::history {
namespace {

const ChannelHead& head_of(const Trend& trend, const std::string& mv, const std::string& cv) {
  return *std::find_if(
      trend.head.channels.begin(), trend.head.channels.end(),
      [&](const ChannelHead& channel) { return channel.mv == mv && channel.cv == cv; });
}

std::string signed_text(double value) { return (value > 0.0 ? "+" : "") + number_text(value, 2); }

std::string gain_text(const ChannelHead& head, double error, double low, double high) {
  if (!known(error)) return "gain not known";
  return "gain " + (head.modelled ? signed_text(error) + " %" : number_text(error)) + " (" +
         interval_text(low, high, head.modelled ? 2 : 3) + ")";
}

std::string before_text(const ChannelHead& head, double before) {
  if (!head.modelled) return "was " + number_text(before) + " before";
  const double limit = 100.0 * head.gain_limit;
  return std::abs(before) <= limit ? "was within " + number_text(limit) + " % before"
                                   : "was " + signed_text(before) + " % before";
}

}  // namespace

std::string channel_name(const std::string& mv, const std::string& cv) {
  return printable(mv) + " -> " + printable(cv);
}

std::string words_of(const Trend& trend, const Change& change, const report::MomentText& moment) {
  const std::string since =
      (change.gradual ? ", gradually since " : " since ") +
      (change.alarm_ns ? moment(*change.alarm_ns) : period_name(trend, change.first));
  if (!change.mv.empty()) {
    const ChannelHead& head = head_of(trend, change.mv, change.cv);
    return channel_name(change.mv, change.cv) + ": " +
           gain_text(head, change.now, change.low, change.high) + since + "; " +
           before_text(head, change.before);
  }
  std::string text = printable(change.cv) + ": prediction errors " + number_text(change.now, 2) +
                     " times as large (" + interval_text(change.low, change.high, 2) + ")" + since;
  const double moved = change.movement_ratio;
  if (moved >= kLeastRatio || moved <= 1.0 / kLeastRatio)
    text += "; it moved " + number_text(moved, 2) + " times as much";
  return text;
}

std::string words_of(const Trend& trend, const Standing& standing,
                     const report::MomentText& moment) {
  return channel_name(standing.mv, standing.cv) + ": " +
         gain_text(head_of(trend, standing.mv, standing.cv), standing.gain_error, standing.low,
                   standing.high) +
         ", in alarm since " +
         (standing.since_ns ? moment(*standing.since_ns) : "before these data begin");
}

std::string words_of(const Trend& trend, const Silence& silence) {
  const ChannelHead& head = head_of(trend, silence.last.mv, silence.last.cv);
  ChannelRecord record;
  record.mv = head.mv;
  record.cv = head.cv;
  record.reason = from_string<Reason>(silence.last.reason).value_or(Reason::kNone);
  record.confounder = silence.last.confounder;
  record.smallest_error = known(silence.last.smallest_error) ? silence.last.smallest_error : 0.0;
  const bool spoke = silence.last.verdict != "undetermined";
  report::ChannelFile file;
  file.modelled = head.modelled;
  for (const ChannelHead& each : trend.head.channels)
    if (each.disturbance) file.disturbances.push_back(each.mv);
  return channel_name(head.mv, head.cv) + ": " +
         (silence.since ? "nothing since " + period_name(trend, *silence.since) + "; " : "") +
         (spoke ? "told for too little of the time" : report::undetermined_text(record, file));
}

std::string words_of_rate(const Trend& trend, const Findings& findings) {
  const std::string step(to_string(trend.step));
  if (findings.asked == 0)
    return "Changes cannot be told: no " + std::string("series has ") +
           std::to_string(level_change::kFewestPoints) + " " + step + "s that are known.";
  return (findings.changes.empty() ? "No change beyond what chance gives" : "Told beyond chance") +
         std::string(": of a history without changes any is told in less than ") +
         percent_text(kFalseRate) + " of cases.";
}

}  // namespace mpm::history
