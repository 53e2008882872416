#pragma once

#include <string>

#include "config/unit_config.hpp"
#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"

namespace mpm::report {

/// Two valves and a flow to two analyses, of which AI-202 does not answer FIC-102.
inline config::UnitConfig column() {
  config::UnitConfig unit;
  unit.unit = "column";
  unit.sample_time_s = 60.0;
  unit.mv = {{"FIC-101", "%", ""}, {"FIC-102", "%", ""}};
  unit.dv = {{"FI-900", "", ""}};
  unit.cv.resize(2);
  unit.cv[0].tag = "AI-201";
  unit.cv[0].unit = "t/h";
  unit.cv[1].tag = "AI-202";
  unit.cv[1].unit = "bar";
  const TransferFunction lag{1.0, {600.0}, 0, 0, false};
  unit.model.channels = {{0, 0, lag}, {1, 0, lag}, {0, 1, lag}, {0, 2, lag}, {1, 2, lag}};
  return unit;
}

inline ChannelRecord match(const std::string& mv, const std::string& cv) {
  ChannelRecord channel;
  channel.mv = mv;
  channel.cv = cv;
  channel.verdict = Verdict::kMatch;
  channel.reason = Reason::kNone;
  channel.model_gain = 0.1;
  return channel;
}

inline ChannelRecord undetermined(const std::string& mv, const std::string& cv, Reason reason,
                                  double smallest_error = 0.0) {
  ChannelRecord channel = match(mv, cv);
  channel.verdict = Verdict::kUndetermined;
  channel.reason = reason;
  channel.smallest_error = smallest_error;
  return channel;
}

/// Gain 41 % too large (31 to 51), of a model whose gain is 0.1; all else as it should be.
inline ChannelRecord mismatch(const std::string& mv, const std::string& cv) {
  ChannelRecord channel = match(mv, cv);
  channel.verdict = Verdict::kMismatch;
  channel.material = channel.usual = true;
  channel.effect_size = 0.041;
  channel.effect_low = 0.031;
  channel.effect_high = 0.051;
  channel.time_constant_low = 0.9;
  channel.time_constant_high = 1.2;
  channel.dead_time_low_s = -60.0;
  channel.dead_time_high_s = 30.0;
  return channel;
}

inline AlarmRecord alarm(const ChannelRecord& channel, AlarmChange to, std::int64_t time_ns) {
  AlarmRecord record;
  record.mv = channel.mv;
  record.cv = channel.cv;
  record.to = to;
  record.source_time_ns = time_ns;
  return record;
}

}  // namespace mpm::report
