#pragma once

#include <string>
#include <vector>

#include "daemon/http/board.hpp"
#include "daemon/report/unit_monitor.hpp"
#include "tests/daemon/live/live_frames.hpp"
#include "tests/daemon/report/sample_channels.hpp"

namespace mpm::test {

/// `column` with a model that can be run.
inline config::UnitConfig whole_column() {
  config::UnitConfig unit = report::column();
  unit.model.sample_time_s = unit.sample_time_s;
  unit.model.input_count = unit.counts().inputs();
  unit.model.cv_count = unit.counts().cv;
  unit.model.input_blocks.resize(3);
  unit.model.output_blocks.resize(2);
  unit.model.input_origin = Eigen::VectorXd::Zero(3);
  unit.model.output_origin = Eigen::VectorXd::Zero(2);
  return unit;
}

/// `column` of sample_channels.hpp on a board, to which a test tells what happens.
struct SampleBoard {
  SampleBoard() { board.fetch({}); }

  /// Frames of the next intervals, at as many minutes after 1970.
  void push(int frames) {
    for (int k = 0; k < frames; ++k) {
      Frame frame = frame_at(next, unit.counts());
      frame.source_time_ns *= 60;
      ++next;
      monitor.push(frame);
      feed().on_frame(frame, monitor);
    }
    fetch();
  }
  /// What is offered, and what was noted while it was.
  void fetch() {
    board.fetch({});
    feed().offer();
    board.fetch({});
  }
  /// An alarm on FIC-101 -> AI-201 and its mismatch; FIC-101 -> AI-202 is not excited; the rest
  /// match.
  void show(bool alarmed) {
    channels.clear();
    for (const std::string& mv : unit.input_tags())
      for (const std::string& cv : unit.cv_tags()) channels.push_back(report::match(mv, cv));
    if (alarmed) {
      channels[0] = report::mismatch("FIC-101", "AI-201");
      channels[0].alarm = AlarmState::kActive;
      channels[0].first_lag = -1;
      channels[0].partial_correlations = {0.1, 0.5, 0.2};
      channels[0].effective_samples = 400.0;
    }
    channels[1] = report::undetermined("FIC-101", "AI-202", Reason::kNotExcited, 0.7);
    alarms.clear();
    for (const ChannelRecord& channel : channels)
      alarms.emplace_back(report::alarm(channel, AlarmChange::kCleared, 0));
    if (alarmed) {
      alarms[0] = AlarmStateRecord(report::alarm(channels[0], AlarmChange::kActive, 7'000'000'000));
      alarms[0].unit = unit.unit;
      alarms[0].view.alarm_state = AlarmWord::kUnacknowledged;
      alarms[0].view.retain = true;
      feed().on_alarm(alarms[0], "gain +41 %");
    }
    health.unit = unit.unit;
    health.state = alarmed ? "maintenance_required" : "normal";
    performance.service_factor = 0.75;
    feed().on_view({channels, alarms, controller, health, troubles, performance});
    fetch();
  }
  [[nodiscard]] http::UnitFeed& feed() { return *board.feed_of(unit.unit); }
  [[nodiscard]] const http::UnitStore& store() const { return *board.find(unit.unit); }

  config::UnitConfig unit = whole_column();
  http::Board board{{unit}};
  report::UnitMonitor monitor{unit};
  std::int64_t next = 1;
  std::vector<ChannelRecord> channels;
  std::vector<AlarmStateRecord> alarms;
  ControllerAlarmRecord controller;
  HealthRecord health;
  std::vector<bus::Trouble> troubles;
  PerformanceRecord performance;
};

}  // namespace mpm::test
