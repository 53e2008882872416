#include "daemon/report/channel_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/daemon/report/sample_channels.hpp"

namespace mpm::report {

TEST_CASE("what the data do not resolve is no number") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  channel.effect_size = 40.0;  // 400 times the model's gain
  channel.effect_low = -40.0;
  channel.effect_high = 120.0;
  channel.time_constant_ratio = channel.dead_time_error_s = std::nan("");
  CHECK(mismatch_text(channel, file) ==
        "gain not known, time constant not known, dead time not known");

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
        "gain ok, time constant +100 % (50 to 150), dead time +240 s (-30 to 510); may be too "
        "small to matter");
  channel.usual = false;
  channel.material = true;
  CHECK(mismatch_text(channel, file) ==
        "gain ok, and not of that alone: the dynamics or the dead time differ by much");
}

TEST_CASE("what the model lacks may answer for a while and have no gain") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  file.modelled = false;
  channel.effect_size = 0.02;
  channel.effect_low = 0.01;
  channel.effect_high = 0.03;
  CHECK(mismatch_text(channel, file).find("answers, where the model has nothing: gain 0.02") == 0);
  channel.effect_low = -0.01;
  const std::string text = mismatch_text(channel, file);
  CHECK(text.find("answers for a while, where the model has nothing: gain 0.02") == 0);
  CHECK(text.find("(-0.01 to 0.03, perhaps none)") != std::string::npos);
}

TEST_CASE("the gain of an integrating channel is said as the unit file gives it, per s") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  CHECK(file.integrating_gain == 0.0);
  file.integrating_gain = -0.02;
  channel.model_gain = -0.8;  // what it rises by in 40 s
  channel.effect_size = -0.24;
  channel.effect_low = -0.32;
  channel.effect_high = -0.16;
  channel.time_constant_ratio = std::nan("");
  const std::string text = mismatch_text(channel, file);
  INFO(text);
  CHECK(text.find("gain +30 % (20 to 40; -0.006 ") == 0);
  CHECK(text.find("/s per ") != std::string::npos);
  CHECK(text.find("time constant") == std::string::npos);
}

TEST_CASE("of a mismatch in which all is nearly as modelled the numbers are said") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  channel.effect_size = 0.002;
  channel.effect_low = -0.001;
  channel.effect_high = 0.005;
  channel.time_constant_ratio = 1.1;
  channel.time_constant_low = 0.9;
  channel.time_constant_high = 1.3;
  channel.dead_time_error_s = 0.0;
  channel.dead_time_low_s = -0.5;
  channel.dead_time_high_s = 0.5;
  channel.material = false;
  const std::string text = mismatch_text(channel, file);
  INFO(text);
  CHECK(text.find(" ok") == std::string::npos);
  CHECK(text.find("gain +") == 0);
  CHECK(text.find(", time constant +10 % (-10 to 30), dead time 0 s (-0.5 to 0.5); may be too "
                  "small to matter") != std::string::npos);
}

TEST_CASE("what an interval holds to be beyond the limit is not called small") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");  // 31 to 51 % too much gain
  ChannelFile file = channel_file(column(), "FIC-101", "AI-201");
  channel.material = false;
  channel.p_value_material = 0.01;
  CHECK(mismatch_text(channel, file).ends_with("; likely to matter, not beyond doubt"));
  channel.p_value_material = 0.6;
  CHECK(mismatch_text(channel, file)
            .ends_with("; not sure to matter: what is allowed of the whole response, with what "
                       "else may be off, explains it too"));
  file.gain_limit = 0.4;
  CHECK(mismatch_text(channel, file).ends_with("; may be too small to matter"));
  config::UnitConfig unit = column();
  unit.monitor.materiality.gain = 0.4;
  CHECK(channel_file(unit, "FIC-101", "AI-201").gain_limit == 0.4);
}

TEST_CASE("of a model whose gain is negative, more gain is more in its direction") {
  ChannelRecord channel = mismatch("FIC-101", "AI-202");
  channel.model_gain = -0.1;
  const ChannelFile file = channel_file(column(), "FIC-101", "AI-202");
  CHECK(mismatch_text(channel, file) ==
        "gain -41 % (-51 to -31; +0.041 bar per %), time constant ok, dead time ok");
  AlarmRecord raised = alarm(channel, AlarmChange::kActive, 0);
  raised.effect_size = -0.037;
  CHECK(error_text(raised, &channel) == "gain +37 %");
  CHECK(error_text(raised, nullptr) == "gain off by -0.037");
  channel.effect_high = 1.0;
  CHECK(error_text(raised, &channel) == "gain not known");
}

TEST_CASE("an alarm tells of the gain only where that may be what is wrong") {
  ChannelRecord channel = mismatch("FIC-101", "AI-201");
  AlarmRecord raised = alarm(channel, AlarmChange::kActive, 0);
  raised.effect_size = channel.effect_size = 0.002;
  channel.effect_low = -0.001;
  channel.effect_high = 0.005;
  CHECK(error_text(raised, &channel) == "gain +2 %");
  channel.dead_time_error_s = 240.0;
  channel.dead_time_low_s = 30.0;
  channel.dead_time_high_s = 510.0;
  CHECK(error_text(raised, &channel) == "dead time +240 s");
  channel.time_constant_ratio = 2.0;
  channel.time_constant_low = 1.5;
  channel.time_constant_high = 2.5;
  CHECK(error_text(raised, &channel) == "time constant +100 %");
  channel.effect_low = 0.001;  // the gain is wrong as well
  CHECK(error_text(raised, &channel) == "gain +2 %");
}

TEST_CASE("a channel that is not linear is told by its kind") {
  ChannelRecord channel = undetermined("FIC-101", "AI-201", Reason::kNotExcited, 0.5);
  CHECK(nonlinear_text(channel).empty());
  channel.nonlinear.kind = NonlinearKind::kHysteresis;
  CHECK(nonlinear_text(channel).empty());  // that is for certain only with the verdict
  channel.nonlinear.verdict = NonlinearVerdict::kNonlinear;
  CHECK(nonlinear_text(channel) ==
        "depends on where FIC-101 came from, as behind a valve that sticks or has play");
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
  CHECK(undetermined_text(undetermined("FIC-101", "AI-201", Reason::kNotExcited, 0.2503), file) ==
        "needs a gain error of 26 % to show; move FIC-101");  // 25 % would have been enough
  CHECK(text(Reason::kCoarse).find("AI-201 is read so coarsely") == 0);
  CHECK(text(Reason::kConfounded).find("what is off in AI-201 goes with the inputs together") == 0);
  CHECK(text(Reason::kConfounded, "AIC-201.SP").find("follows AIC-201.SP") != std::string::npos);
  CHECK(text(Reason::kCollinear, "FIC-102") ==
        "moved only together with FIC-102; move one without the other");
  CHECK(
      text(Reason::kBadData) ==
      "AI-201 or FIC-101 is too often missing, bad, or the same for several samples; what is read "
      "only now and then needs a unit of its own, with a sample_time as long");
  CHECK(text(Reason::kControllerOff) ==
        "no manipulated variable moves: the controller is off or in manual");
  CHECK(text(Reason::kConstrained) == "FIC-101 rests at a limit; move it away from there");
  CHECK(text(Reason::kIsolating) ==
        "something changed in AI-201; too few samples since then to tell which channel");
}

TEST_CASE("nobody is asked to move what is only measured") {
  const auto text = [](const std::string& mv, Reason reason, const std::string& confounder = "") {
    ChannelRecord channel = undetermined(mv, "AI-202", reason, 0.5);
    channel.confounder = confounder;
    return undetermined_text(channel, channel_file(column(), mv, "AI-202"));
  };
  CHECK(text("FI-900", Reason::kNotExcited) ==
        "needs a gain error of 50 % to show; wait until FI-900 moves");
  CHECK(text("FI-900", Reason::kCollinear, "FIC-101") ==
        "moved only together with FIC-101; move FIC-101 without it");
  CHECK(text("FIC-101", Reason::kCollinear, "FI-900") ==
        "moved only together with FI-900; move FIC-101 without it");
  CHECK(text("FI-900", Reason::kConstrained) == "FI-900 rests at a limit; wait until it leaves it");
}

}  // namespace mpm::report
