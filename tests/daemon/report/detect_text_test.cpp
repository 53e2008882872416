#include "daemon/report/detect_text.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "tests/daemon/report/sample_channels.hpp"

namespace mpm::report {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kNoon = 1'772'539'200 * kSecond;  // 2026-03-03T12:00:00Z

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
  FI-900 -> AI-201: moved too little to tell anything; wait until FI-900 moves

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
  report.last_ns = -2 * kSecond;
  CHECK(to_text(report, column(), {100, false})
            .starts_with("column: 200 samples from 0 s to -2 s, the clock went back; 1 used, "));
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

TEST_CASE("bad values are told with the tags that have most of them") {
  DetectReport report = march();
  report.bad_values = 14;
  report.frozen = 5;
  report.bad_tags = {{"AI-201", 9}, {"FIC-102", 3}};
  CHECK(to_text(report, column(), {200, false})
            .find("2860 used, 14 bad values (5 frozen), of AI-201 (9), FIC-102 (3)\n") !=
        std::string::npos);
  report.bad_tags.insert(report.bad_tags.end(), {{"AI-202", 1}, {"FIC-101", 1}});
  CHECK(to_text(report, column(), {200, false})
            .find("of AI-201 (9), FIC-102 (3), AI-202 (1) and 1 other\n") != std::string::npos);
}

TEST_CASE("what warms up says how many samples it still needs") {
  DetectReport report = march();
  report.channels = {undetermined("FIC-101", "AI-201", Reason::kWarmingUp)};
  CHECK(to_text(report, column(), {200, false}).find("too few samples yet\n") != std::string::npos);
  report.samples_needed["AI-201"] = 336.2;
  CHECK(
      to_text(report, column(), {200, false}).find("too few samples yet; needs about 340 more\n") !=
      std::string::npos);
}

TEST_CASE("predictions that are not used are named, with the reason") {
  DetectReport report = march();
  CHECK(to_text(report, column(), {200, false}).find("Not used") == std::string::npos);
  CHECK_FALSE(to_json(report).contains("corrected_predictions"));
  report.corrected_predictions = {"AI-201.PRED", "AI-202.PRED"};
  CHECK(to_text(report, column(), {200, false})
            .find("Not used: AI-201.PRED, AI-202.PRED. What stands there is corrected") !=
        std::string::npos);
  CHECK(to_json(report)["corrected_predictions"] == report.corrected_predictions);
}

TEST_CASE("predictions of another model than the unit file's are named") {
  DetectReport report = march();
  CHECK(to_text(report, column(), {200, false}).find("Of another model") == std::string::npos);
  CHECK_FALSE(to_json(report).contains("other_predictions"));
  report.other_predictions = {"AI-201.PRED"};
  CHECK(to_text(report, column(), {200, false})
            .find("Of another model: AI-201.PRED. What stands there is not what the unit file's "
                  "model gives") != std::string::npos);
  CHECK(to_json(report)["other_predictions"] == report.other_predictions);
}

TEST_CASE("CVs that are a row off are told as such") {
  DetectReport report = march();
  CHECK(mismatching_cvs(report.channels) == 1);
  CHECK_FALSE(all_match(report.channels));
  CHECK(to_text(report, column(), {200, false}).find("Time stamps") == std::string::npos);
  CHECK_FALSE(to_json(report).contains("matches_with_cvs"));
  report.other_row = OtherRow::kEarlier;
  CHECK(to_text(report, column(), {200, false})
            .find("Time stamps: with the CVs a row earlier no channel mismatches. They are "
                  "probably logged a row too late beside the MVs") != std::string::npos);
  CHECK(to_json(report)["matches_with_cvs"] == "a row earlier");
  report.channels = {match("FIC-101", "AI-201"),
                     undetermined("FIC-101", "AI-202", Reason::kNotExcited, 0.28)};
  CHECK(all_match(report.channels));
  report.channels.erase(report.channels.begin());
  CHECK_FALSE(all_match(report.channels));  // none does
}

TEST_CASE("many rows out of order are told apart, a few by their number") {
  DetectReport report = march();  // of 2880 samples
  report.out_of_order = 28;
  CHECK(to_text(report, column(), {200, false}).find("Left out") == std::string::npos);
  report.out_of_order = 29;
  CHECK(to_text(report, column(), {200, false})
            .find("Left out: 29 rows, for their time does not grow. Where that comes of time "
                  "stamps that jitter by more than half a sample") != std::string::npos);
}

}  // namespace mpm::report
