#pragma once

#include "core/record/alarm_record.hpp"
#include "core/record/channel_record.hpp"
#include "core/record/command_record.hpp"
#include "core/record/controller_alarm_record.hpp"
#include "core/record/health_record.hpp"
#include "core/record/performance_record.hpp"

/// Records in which no two numbers or texts are the same, so that none can stand in for another.
namespace mpm::test {

[[nodiscard]] inline ChannelRecord mismatching_channel() {
  ChannelRecord record;
  record.unit = "shell";
  record.mv = "FIC-101.SP";
  record.cv = "TI-7 °C";
  record.interval = 4711;
  record.source_time_ns = 1'714'564'800'250'000'000;
  record.verdict = Verdict::kMismatch;
  record.reason = Reason::kNone;
  record.p_value = 1.25e-12;
  record.statistic = 9.1;
  record.threshold = 3.3;
  record.partial_correlation = -0.41;
  record.lag = 9;
  record.excited = true;
  record.p_value_material = 0.03125;
  record.material = true;
  record.effect_size = 1.2;
  record.effect_low = 0.7;
  record.effect_high = 1.7;
  record.model_gain = -4.05;
  record.usual = true;
  record.time_constant_ratio = 1.5;
  record.time_constant_low = 1.1;
  record.time_constant_high = 2.25;
  record.dead_time_error_s = -60.0;
  record.dead_time_low_s = -90.5;
  record.dead_time_high_s = -29.5;
  record.smallest_error = 0.08;
  record.effective_samples = 3999.5;
  record.gain_variation = 0.375;
  record.nonlinear = {.tested = true,
                      .verdict = NonlinearVerdict::kNonlinear,
                      .kind = NonlinearKind::kInputCurve,
                      .p_value = 2.5e-9,
                      .statistic = 4.5,
                      .share = 0.0625,
                      .material = true,
                      .smallest_variation = 0.125};
  record.alarm = AlarmState::kActive;
  record.first_lag = -2;
  record.partial_correlations = {0.01, -0.02, 0.3, 0.0};
  return record;
}

/// Undetermined, of a model without a gain; everything else says nothing.
[[nodiscard]] inline ChannelRecord collinear_channel() {
  ChannelRecord record;
  record.unit = "shell";
  record.mv = "u1";
  record.cv = "y2";
  record.interval = 12;
  record.source_time_ns = 12'000'000'000;
  record.reason = Reason::kCollinear;
  record.confounder = "u3";
  record.p_value = 0.5;
  record.first_lag = 1;
  record.partial_correlations = {0.25};
  return record;
}

[[nodiscard]] inline AlarmRecord alarm(AlarmChange to) {
  AlarmRecord record;
  record.unit = "shell";
  record.mv = "FIC-101.SP";
  record.cv = "y1";
  record.interval = 812;
  record.source_time_ns = 812'000'000'001;
  record.to = to;
  record.p_value = 3e-9;
  record.statistic = 11.5;
  record.threshold = 3.5;
  record.partial_correlation = 0.625;
  record.lag = 4;
  record.effect_size = -0.75;
  return record;
}

[[nodiscard]] inline AlarmRecord diagnosed_alarm() {
  AlarmRecord record = alarm(AlarmChange::kDiagnosed);
  record.named = {"dynamics",
                  "y1 answers FIC-101.SP late.",
                  0.98,
                  {{"gain_ratio", 0.75, 0.72, 0.78}, {"dead_time_error", 60.0, 30.0, 90.5}}};
  return record;
}

[[nodiscard]] inline ControlRoomView shelved_view() {
  ControlRoomView view;
  view.alarm_state = AlarmWord::kShelved;
  view.acknowledged = false;
  view.shelving_state = Shelving::kOneShot;
  view.unshelve_time_ns = 7001;
  view.suppressed = true;
  view.suppressed_by_design = true;
  view.out_of_service = true;
  view.retain = true;
  view.active_time_ns = 7002;
  view.ack_time_ns = 7003;
  view.client_user_id = "ann";
  view.comment = "work order 4711";
  view.notification_class = NotificationClass::kAlarm;
  view.priority = AlarmPriority::kHigh;
  view.severity = 833;
  view.message = "gain +41 %";
  return view;
}

[[nodiscard]] inline ControllerAlarmRecord controller_alarm() {
  ControllerAlarmRecord record;
  record.unit = "shell";
  record.interval = 5;
  record.source_time_ns = 5'000'000'000;
  record.state = AlarmState::kActive;
  record.view = shelved_view();
  record.channels = 3;
  record.consequence = "the column floods";
  record.action = "shed u1";
  record.time_to_respond_s = 600.0;
  record.guidance = "see the shift book";
  record.display_url = "http://plant/hmi";
  record.runbook = "RB-7";
  return record;
}

[[nodiscard]] inline CommandRecord command() {
  CommandRecord record;
  record.unit = "shell";
  record.mv = "u1";
  record.cv = "y1";
  record.action = "shelve";
  record.duration_s = 28800;
  record.once = true;
  record.user = "ann";
  record.host = "panel";
  record.comment = "3:abc,";  // as a netstring itself
  record.id = "4711";
  record.time_ns = 1234567;
  record.proof = "0a1b";
  return record;
}

[[nodiscard]] inline HealthRecord health() {
  HealthRecord record;
  record.unit = "shell";
  record.state = "maintenance_required";
  record.detail = "2 alarms";
  record.interval = 99;
  record.source_time_ns = 99'000'000'000;
  record.frames = 101;
  record.used = 102;
  record.missing = 103;
  record.incomplete = 104;
  record.late = 105;
  record.repeated = 106;
  record.out_of_order = 107;
  record.bad_values = 108;
  record.wrong_length = 109;
  record.unknown_unit = 110;
  record.restarts = 111;
  record.undetermined = 112;
  record.matching = 113;
  record.mismatching = 114;
  record.active_alarms = 115;
  record.silenced_alarms = 117;
  record.beyond = 116;
  return record;
}

/// Of the second CV and the second MV next to nothing is known.
[[nodiscard]] inline PerformanceRecord performance() {
  PerformanceRecord record;
  record.unit = "shell";
  record.interval = 600;
  record.source_time_ns = 601'000'000'000;
  record.window_samples = 28800;
  record.samples = 599;
  record.service_factor = 0.9375;
  CvPerformance known;
  known.cv = "y1";
  known.engineering_unit = "degC";
  known.setpoint = "sp1";
  known.samples = 598;
  known.control_error = {-0.125, 0.25, 0.5156};
  known.outside_limits = 0.0625;
  known.prediction = {{1, 0.1, 0.2}, {90, 0.3, 0.7}};
  record.cvs = {known, CvPerformance()};
  record.cvs[1].cv = "y2";
  MvPerformance used;
  used.mv = "u1";
  used.engineering_unit = "%";
  used.samples = 597;
  used.at_low = 0.01;
  used.at_high = 0.02;
  used.at_limits = 0.03;
  used.travel = 0.75;
  used.standing = 0.5;
  record.mvs = {used, MvPerformance()};
  record.mvs[1].mv = "u2";
  return record;
}

}  // namespace mpm::test
