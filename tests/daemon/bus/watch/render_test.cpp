#include <algorithm>
#include <catch2/catch.hpp>

#include "daemon/bus/watch/render.hpp"

namespace mpm::bus {
namespace {

ChannelRecord channel(const std::string& mv, const std::string& cv, Verdict verdict,
                      Reason reason = Reason::kNone) {
  ChannelRecord record;
  record.unit = "shell";
  record.mv = mv;
  record.cv = cv;
  record.verdict = verdict;
  record.reason = reason;
  return record;
}

AlarmStateRecord alarm(const std::string& mv, const std::string& cv, AlarmChange to) {
  AlarmStateRecord record;
  record.unit = "shell";
  record.mv = mv;
  record.cv = cv;
  record.to = to;
  return record;
}

}  // namespace

TEST_CASE("tags are ordered as people count") {
  std::vector<std::string> tags = {"u10", "u2", "FIC-101.PV", "u1", "FIC-9.PV", "u", "u02b"};
  std::sort(tags.begin(), tags.end(), natural_less);
  CHECK(tags == std::vector<std::string>{"FIC-9.PV", "FIC-101.PV", "u", "u1", "u2", "u02b", "u10"});
  CHECK_FALSE(natural_less("u2", "u2"));
}

TEST_CASE("rows and columns follow the layout, then the natural order") {
  Board board("");
  for (const std::string input : {"u10", "d1", "u2", "u1"})
    board.update(channel(input, "y1", Verdict::kMatch));
  const UnitBoard& unit = board.units().at("shell");
  CHECK(unit.inputs == std::vector<std::string>{"d1", "u1", "u2", "u10"});
  board.update(idl::LayoutRecord{"shell", "mv", {"u10", "u1", "u2"}});
  board.update(idl::LayoutRecord{"shell", "dv", {"d1"}});
  CHECK(unit.inputs == std::vector<std::string>{"u10", "u1", "u2", "d1"});
}

TEST_CASE("a monitor that starts anew does not stand by what the one before it said") {
  const bool heard_of_the_end = GENERATE(true, false);
  Board board("");
  HealthRecord health;
  health.unit = "shell";
  health.frames = 812;
  board.update(health);
  board.update(channel("u1", "y1", Verdict::kMismatch));
  board.update(alarm("u1", "y1", AlarmChange::kActive));
  health.frames = 813;
  board.update(health);
  CHECK(board.units().at("shell").channels.size() == 1);
  if (heard_of_the_end) board.update(idl::MonitorGone{"shell"});
  health.frames = 0;
  board.update(health);
  CHECK(board.units().at("shell").channels.empty());
  CHECK_FALSE(board.any_alarm());
  CHECK(render(board, {false, false}).find("mismatch") == std::string::npos);
}

TEST_CASE("of two monitors one is shown, whole, and the other once that has left") {
  using namespace std::chrono_literals;
  constexpr Board::Clock::time_point kNow{1h};
  Board board("");
  const auto say = [&](const idl::Output& output, const std::string& writer) {
    const bool listens = board.listens_to(output, writer, kNow);
    board.update(output, writer);
    return listens;
  };
  const auto picture = [&] { return render(board, {false, false}); };
  board.update(idl::LayoutRecord{"shell", "mv", {"u2", "u1"}});
  CHECK(say(channel("u1", "y1", Verdict::kMatch), "first"));
  CHECK_FALSE(say(channel("u1", "y1", Verdict::kMismatch), "second"));
  CHECK_FALSE(say(channel("u2", "y1", Verdict::kMatch), "second"));
  CHECK_FALSE(say(alarm("u1", "y1", AlarmChange::kActive), "second"));
  CHECK(picture().find("mismatch") == std::string::npos);
  CHECK(picture().find("no active alarms") != std::string::npos);
  CHECK(picture().find("two monitors publish for it: first, second") != std::string::npos);

  CHECK(say(idl::MonitorGone{"shell"}, "first"));
  CHECK(picture().find("monitor gone") != std::string::npos);
  CHECK(say(channel("u2", "y1", Verdict::kMatch), "second"));
  CHECK(picture().find("two monitors") == std::string::npos);
  CHECK(picture().find("monitor gone") == std::string::npos);
  CHECK(picture().find("mismatch") != std::string::npos);  // said before its turn came
  CHECK(board.any_alarm());
  CHECK(board.units().at("shell").inputs == std::vector<std::string>{"u2", "u1"});
}

TEST_CASE("the picture says every verdict in words, why it is undetermined, and the alarms") {
  Board board("");
  CHECK(render(board, {}) == "waiting for a monitor ...\n");
  board.update(channel("u1", "y1", Verdict::kMatch));
  board.update(channel("u2", "y1", Verdict::kUndetermined, Reason::kNotExcited));
  ChannelRecord bad = channel("u1", "y2", Verdict::kMismatch);
  bad.alarm = AlarmState::kActive;
  board.update(bad);
  AlarmStateRecord raised = alarm("u1", "y2", AlarmChange::kActive);
  raised.effect_size = 0.3;
  board.update(raised);
  CHECK(board.any_alarm());

  const std::string plain = render(board, {{80, false}, false});
  CHECK(plain.find('\x1b') == std::string::npos);
  CHECK(plain.find("  y1  match       undetermined") != std::string::npos);
  CHECK(plain.find("              not_excited") != std::string::npos);
  CHECK(plain.find("  y2  mismatch !") != std::string::npos);
  CHECK(plain.find("! u1 -> y2  since -  gain off by 0.3  p 1.0e+00") != std::string::npos);
  CHECK(render(board, {{80, true}, false}).find("\x1b[90mundetermined") != std::string::npos);
  CHECK(render(board, {{80, false}, true}).find("undetermined") == std::string::npos);

  HealthRecord blind;
  blind.unit = "shell";
  blind.state = "failure";
  blind.detail = "no data for 5 s";
  blind.source_time_ns = 1'700'000'000'000'000'000;
  board.update(blind);
  CHECK(render(board, {{80, false}, false})
            .find("no verdicts now; those below are of 2023-11-14T22:13:20Z") != std::string::npos);
  CHECK(render(board, {{80, true}, false}).find("\x1b[90mmismatch !") != std::string::npos);

  board.update(alarm("u1", "y2", AlarmChange::kCleared));
  CHECK_FALSE(board.any_alarm());
  board.update(idl::MonitorGone{"shell"});
  CHECK(render(board, {{80, false}, false}).find("monitor gone") != std::string::npos);
}

TEST_CASE("only the unit asked for is shown, and samples are counted by interval") {
  Board board("shell");
  ChannelRecord other = channel("u1", "y1", Verdict::kMatch);
  other.unit = "column";
  board.update(other);
  CHECK(board.units().empty());
  for (std::int64_t k = 1; k <= 5; ++k)
    for (const std::string input : {"u1", "u2"}) {
      ChannelRecord record = channel(input, "y1", Verdict::kMatch);
      record.interval = k;
      board.update(record);
    }
  CHECK(board.units().at("shell").samples == 5);
  board.take_rate(std::chrono::seconds(2));
  CHECK(board.units().at("shell").samples_per_s == 2.5);
}

TEST_CASE("a line is due when a verdict or its reason changes, not before") {
  const ChannelRecord warming = channel("u1", "y1", Verdict::kUndetermined, Reason::kWarmingUp);
  CHECK(change_line(nullptr, warming) == "- shell u1 -> y1: undetermined (warming_up)");
  CHECK(change_line(&warming, warming).empty());
  const ChannelRecord match = channel("u1", "y1", Verdict::kMatch);
  CHECK(change_line(&warming, match).find("match") != std::string::npos);
}

TEST_CASE("the table is no wider than the terminal") {
  Board board("");
  for (const std::string input : {"u1", "u2", "u3"})
    board.update(channel(input, "y1", Verdict::kUndetermined, Reason::kNotExcited));
  CHECK(render(board, {{36, false}, false}) ==
        "shell  1 sample, 0.0/s\n"
        "      u1            u2\n"
        "  y1  undetermined  undetermined\n"
        "      not_excited   not_excited\n"
        "\n"
        "      u3\n"
        "  y1  undetermined\n"
        "      not_excited\n"
        "  no active alarms\n\n");
}

TEST_CASE("an alarm tells its error in per cent of the model's gain where that is known") {
  AlarmStateRecord raised = alarm("u1", "y2", AlarmChange::kActive);
  raised.effect_size = -0.8;
  raised.p_value = 1e-9;
  ChannelRecord known = channel("u1", "y2", Verdict::kMismatch);
  known.model_gain = -2.0;
  known.effect_low = -1.0;
  known.effect_high = -0.6;
  CHECK(change_line(raised, &known) == "- shell u1 -> y2: alarm active (gain +40 %, p 1.0e-09)");
  CHECK(change_line(raised, nullptr) ==
        "- shell u1 -> y2: alarm active (gain off by -0.8, p 1.0e-09)");
  Board board("");
  board.update(known);
  board.update(raised);
  CHECK(render(board, {{80, false}, true}).find("! u1 -> y2  since -  gain +40 %  p 1.0e-09\n") !=
        std::string::npos);
}

}  // namespace mpm::bus
