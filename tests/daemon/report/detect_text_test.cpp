#include "daemon/report/detect_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "daemon/report/channel_text.hpp"
#include "daemon/report/moment_text.hpp"

namespace mpm::report {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kNoon = 1'772'539'200 * kSecond;  // 2026-03-03T12:00:00Z

/// Two valves and a flow to two analyses, of which AI-202 does not answer FIC-102.
config::UnitConfig column() {
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

ChannelRecord match(const std::string& mv, const std::string& cv) {
  ChannelRecord channel;
  channel.mv = mv;
  channel.cv = cv;
  channel.verdict = Verdict::kMatch;
  channel.reason = Reason::kNone;
  channel.model_gain = 0.1;
  return channel;
}

ChannelRecord undetermined(const std::string& mv, const std::string& cv, Reason reason,
                           double smallest_error = 0.0) {
  ChannelRecord channel = match(mv, cv);
  channel.verdict = Verdict::kUndetermined;
  channel.reason = reason;
  channel.smallest_error = smallest_error;
  return channel;
}

/// Gain 41 % too large (31 to 51), of a model whose gain is 0.1; all else as it should be.
ChannelRecord mismatch(const std::string& mv, const std::string& cv) {
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

AlarmRecord alarm(const ChannelRecord& channel, AlarmChange to, std::int64_t time_ns) {
  AlarmRecord record;
  record.mv = channel.mv;
  record.cv = channel.cv;
  record.to = to;
  record.source_time_ns = time_ns;
  return record;
}

DetectReport march() {
  DetectReport report;
  report.unit = "column";
  report.samples = 2880;
  report.used_samples = 2860;
  report.first_ns = kNoon - 48 * 3600 * kSecond;
  report.last_ns = kNoon - 60 * kSecond;
  report.channels = {mismatch("FIC-101", "AI-201"),
                     undetermined("FIC-101", "AI-202", Reason::kNotExcited, 0.28),
                     match("FIC-102", "AI-201"),
                     undetermined("FIC-102", "AI-202", Reason::kNotExcited, 9.0),
                     undetermined("FI-900", "AI-201", Reason::kNotExcited, 37.2),
                     match("FI-900", "AI-202")};
  report.channels[0].alarm = AlarmState::kActive;
  report.alarms = {alarm(report.channels[0], AlarmChange::kActive, kNoon - 40 * 3600 * kSecond),
                   alarm(report.channels[0], AlarmChange::kCleared, kNoon - 39 * 3600 * kSecond),
                   alarm(report.channels[0], AlarmChange::kActive, kNoon - 9400 * kSecond)};
  return report;
}

}  // namespace

TEST_CASE("a report tells what was read, the verdicts, and what to do about them") {
  CHECK(
      to_text(march(), column(), {100, false}) ==
      R"(column: 2880 samples from 12:00 on 1 March 2026 to 11:59 on 3 March 2026 (UTC); 2860 used, no bad
  values

           AI-201  AI-202
  FIC-101  X!      u
  FIC-102  m       u
  FI-900   u       m

  m match, X mismatch, u undetermined, ! in alarm

Mismatch
  FIC-101 -> AI-201: gain +41 % (31 to 51; +0.041 t/h per %), time constant ok, dead time ok, since
    09:23 on 3 March

Undetermined
  FIC-101 -> AI-202: needs a gain error of 28 % to show; move FIC-101
  FIC-102 -> AI-202: moved too little to show whether AI-202 answers it; move FIC-102
  FI-900 -> AI-201: moved too little to tell anything; move FI-900

Alarms that are over
  FIC-101 -> AI-201: from 20:00 on 1 March to 21:00 on 1 March
)");
}

TEST_CASE("no line of a report is wider than the terminal, whatever the tags") {
  DetectReport report = march();
  report.channels.clear();
  for (const std::string mv : {"AREA-1.UNIT-27.FIC-101.SETPOINT", "u2"})
    for (const std::string cv : {"AREA-1.UNIT-27.AI-201", "AREA-1.UNIT-27.AI-202", "y3", "y4"})
      report.channels.push_back(match(mv, cv));
  report.channels[1] = mismatch(report.channels[1].mv, report.channels[1].cv);
  CHECK(to_text(report, column(), {40, false}) ==
        R"(column: 2880 samples from 12:00 on 1
  March 2026 to 11:59 on 3 March 2026
  (UTC); 2860 used, no bad values

                ARE..201  ARE..202  y3
  AREA-..POINT  m         X         m
  u2            m         m         m

                y4
  AREA-..POINT  m
  u2            m

  m match, X mismatch

Mismatch
  AREA-1...TPOINT -> AREA-1...AI-202:
    answers, where the model has
    nothing: gain 0.041 (0.031 to 0.051)
)");
}

TEST_CASE("what the data do not resolve is no number") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  channel.effect_size = 40.0;  // 400 times the model's gain
  channel.effect_low = -40.0;
  channel.effect_high = 120.0;
  channel.time_constant_ratio = channel.dead_time_error_s = std::nan("");
  CHECK(mismatch_text(channel, file) == "gain --, time constant --, dead time --");

  channel = mismatch("FIC-101", "AI-201");
  channel.time_constant_ratio = 2.0;
  channel.time_constant_low = 1.5;
  channel.time_constant_high = 2.5;
  channel.dead_time_error_s = 240.0;
  channel.dead_time_low_s = -30.0;
  channel.dead_time_high_s = 510.0;  // holds 0, but much else
  channel.effect_low = -0.01;
  channel.effect_high = 0.02;
  channel.material = false;
  CHECK(mismatch_text(channel, file) ==
        "gain ok, time constant +100 % (50 to 150), dead time +240 s (-30 to 510); too small to "
        "matter");
  channel.usual = false;
  channel.material = true;
  CHECK(mismatch_text(channel, file) ==
        "gain ok, and not of that alone: the dynamics or the dead time differ by much");
}

TEST_CASE("of a model whose gain is negative, more gain is more in its direction") {
  ChannelRecord channel = mismatch("FIC-101", "AI-202");
  channel.model_gain = -0.1;
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-202");
  CHECK(mismatch_text(channel, file) ==
        "gain -41 % (-51 to -31; +0.041 bar per %), time constant ok, dead time ok");
  AlarmRecord raised = alarm(channel, AlarmChange::kActive, 0);
  raised.effect_size = -0.037;
  CHECK(gain_text(raised, &channel) == "gain +37 %");
  CHECK(gain_text(raised, nullptr) == "gain off by -0.037");
  channel.effect_high = 1.0;
  CHECK(gain_text(raised, &channel) == "gain --");
}

TEST_CASE("every reason has its words") {
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  const auto text = [&](Reason reason, const std::string& confounder = "") {
    ChannelRecord channel = undetermined("FIC-101", "AI-201", reason, 0.5);
    channel.confounder = confounder;
    return undetermined_text(channel, file);
  };
  CHECK(text(Reason::kWarmingUp) == "too few samples yet");
  CHECK(text(Reason::kNotExcited) == "needs a gain error of 50 % to show; move FIC-101");
  CHECK(text(Reason::kCollinear, "FIC-102") ==
        "moved only together with FIC-102; move one without the other");
  CHECK(text(Reason::kBadData) == "too much of what it needs is missing or bad");
  CHECK(text(Reason::kControllerOff) ==
        "no manipulated variable moves: the controller is off or in manual");
  CHECK(text(Reason::kConstrained) == "FIC-101 rests at a limit; move it away from there");
  CHECK(text(Reason::kIsolating) ==
        "something changed in AI-201; too few samples since then to tell which channel");
}

TEST_CASE("data without dates are told in their seconds, and one of a thing is singular") {
  DetectReport report;
  report.unit = "column";
  report.samples = report.used_samples = 1;
  report.bad_values = report.spikes = 1;
  report.channels = {match("FIC-101", "AI-201")};
  CHECK(to_text(report, column()) ==
        "column: 1 sample at 0 s; 1 used, 1 bad value (1 spike)\n\n"
        "           AI-201\n"
        "  FIC-101  m\n\n"
        "  m match\n");
  report.samples = 200;
  report.last_ns = 11940 * kSecond;
  report.missing = 3;
  report.bad_values = 7;
  report.frozen = 2;
  report.spikes = 2;
  report.channels[0].alarm = AlarmState::kActive;
  report.alarms = {alarm(report.channels[0], AlarmChange::kActive, 4300 * kSecond + kSecond / 2)};
  CHECK(to_text(report, column(), {100, false}) ==
        "column: 200 samples from 0 s to 11940 s; 1 used, 3 missing, 7 bad values (2 frozen, 2 "
        "spikes)\n\n"
        "           AI-201\n"
        "  FIC-101  m!\n\n"
        "  m match, ! in alarm\n\n"
        "Mismatch\n"
        "  FIC-101 -> AI-201: matches by now, still in alarm, since 4300.5 s\n");
}

TEST_CASE("times are told in the zone that was asked for, and their year where it is another one") {
  const files::TimeZone zone("Asia/Kolkata");  // UTC+05:30, all the year
  const MomentText moment(kNoon, 60.0, &zone);
  CHECK(moment(kNoon) == "17:30 on 3 March");
  CHECK(moment(kNoon - 365 * 24 * 3600 * kSecond) == "17:30 on 3 March 2025");
  CHECK(moment.zone() == " (Asia/Kolkata)");
  CHECK(MomentText(kNoon, 1.0, nullptr)(kNoon + kSecond) == "12:00:01 on 3 March");
}

TEST_CASE("colour is only added where it is wanted") {
  const std::string plain = to_text(march(), column(), {80, false});
  std::string colored = to_text(march(), column(), {80, true});
  CHECK(plain.find('\x1b') == std::string::npos);
  CHECK(colored.find("\x1b[1;31mX!    \x1b[0m") != std::string::npos);
  for (std::size_t at = 0; (at = colored.find('\x1b')) != std::string::npos;)
    colored.erase(at, colored.find('m', at) - at + 1);
  CHECK(colored == plain);
}

TEST_CASE("tags are cut in the middle by characters, not by bytes") {
  CHECK(shortened("FIC-101", 7) == "FIC-101");
  CHECK(shortened("FIC-101.PV", 7) == "FIC..PV");
  CHECK(shortened("K\u00e4ltem\u00e4\u00dfig", 6) == "K\u00e4..ig");
  CHECK(columns_of("K\u00e4lte") == 5);
  CHECK(padded("K\u00e4lte", 7) == "K\u00e4lte  ");
  CHECK(wrapped("about 41 % of it", 1, 11) == " about 41 %\n   of it\n");
}

}  // namespace mpm::report
