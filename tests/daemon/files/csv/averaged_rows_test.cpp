#include "daemon/files/csv/averaged_rows.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "config/load_unit.hpp"
#include "daemon/files/csv/csv_reader.hpp"

namespace mpm::files::averaged_rows_test {
namespace {

config::UnitConfig unit_of(const char* sample_time) {
  return config::load_unit_text(
             std::string("unit: u\nsample_time: ") + sample_time +
                 "\nsignals: {mv: u, cv: {tag: y, setpoint: sp}, aux: [a]}\n"
                 "model: {channels: [{cv: y, mv: u, gain: 1, time_constants: [9]}]}\n",
             "unit.yaml")
      .config;
}

struct Read {
  std::vector<Frame> frames;
  std::vector<std::string> notices;
};

Read read(const std::string& text, const char* sample_time = "10") {
  CsvReader reader(std::make_unique<std::istringstream>(text), "d.csv", unit_of(sample_time));
  Read result;
  Frame frame;
  while (reader.next(frame)) result.frames.push_back(frame);
  result.notices = reader.notices();
  return result;
}

double value(const Frame& frame, SignalKind kind) { return frame[kind].values(0); }
Quality quality(const Frame& frame, SignalKind kind) { return frame[kind].quality[0]; }

}  // namespace

// u = a = t and y = sp = t: the mean of the times 10 k ... 10 k + 9 is 10 k + 4.5.
TEST_CASE("inputs are means over the interval in which they act, CVs what was measured before") {
  std::string text = "time,u,y,sp,a\n";
  for (int t = 0; t < 3000; ++t) {
    const std::string now = std::to_string(t);
    text += now + ',' + now + ',' + now + ',' + now + ',' + now + '\n';
  }
  const Read read = averaged_rows_test::read(text);
  REQUIRE(read.frames.size() == 300);
  for (int k = 0; k < 300; ++k) {
    CAPTURE(k);
    const Frame& frame = read.frames[static_cast<std::size_t>(k)];
    CHECK(frame.interval == k);
    CHECK(frame.source_time_ns == k * 10'000'000'000);
    CHECK(value(frame, SignalKind::kMv) == Approx(10 * k + 4.5));
    CHECK(value(frame, SignalKind::kAux) == Approx(10 * k + 4.5));
    CHECK(value(frame, SignalKind::kCv) == 10 * k);
    CHECK(value(frame, SignalKind::kSetpoint) == 10 * k);
    CHECK(quality(frame, SignalKind::kMv) == Quality::kGood);
  }
  REQUIRE(read.notices.size() == 1);
  CHECK(read.notices[0] == "the rows, 1 s apart, are averaged to the unit's sample_time of 10 s");
}

TEST_CASE("time stamps that jitter, or that no interval is a multiple of, lose no row") {
  // Steps of 0.97 and 1.03 s by turns; then steps of 3 s, of which 3 or 4 fall into 10 s.
  std::string text = "time,u,y,sp,a\n";
  for (int t = 0; t < 600; ++t) text += std::to_string(t + 0.03 * (t % 2)) + ",2,3,4,5\n";
  CHECK(read(text).frames.size() == 60);
  text = "time,u,y,sp,a\n";
  for (int t = 0; t < 600; t += 3) text += std::to_string(t) + ',' + std::to_string(t) + ",3,4,5\n";
  const Read read = averaged_rows_test::read(text);
  REQUIRE(read.frames.size() == 60);
  // 0 3 6 9, 12 15 18, 21 24 27, and so on again from 30; 29 and 28.5 are none of their rows.
  CHECK(value(read.frames[0], SignalKind::kMv) == Approx(4.5));
  CHECK(value(read.frames[1], SignalKind::kMv) == Approx(15.0));
  CHECK(value(read.frames[2], SignalKind::kMv) == Approx(24.0));
  CHECK(value(read.frames[3], SignalKind::kMv) == Approx(34.5));
}

TEST_CASE("means are of what is good, else of what is uncertain, else there is none") {
  std::string text = "time,u,u.quality,y,sp,a\n";
  for (int t = 0; t < 60; ++t) {
    const int k = t / 10, n = t % 10;
    const char* word = "good";
    if (k == 1 && n >= 2) word = "uncertain";  // 2 good ones, of value 0 and 1
    if (k == 2) word = n < 5 ? "bad" : "uncertain";
    if (k == 3) word = "bad";
    text += std::to_string(t) + ',' + (k == 4 && n != 7 ? "" : std::to_string(n)) + ',' + word +
            ",1,1,1\n";
  }
  const std::vector<Frame> frames = read(text).frames;
  REQUIRE(frames.size() == 6);
  CHECK(value(frames[1], SignalKind::kMv) == Approx(0.5));
  CHECK(quality(frames[1], SignalKind::kMv) == Quality::kGood);
  CHECK(value(frames[2], SignalKind::kMv) == Approx(7.0));  // of 5 ... 9
  CHECK(quality(frames[2], SignalKind::kMv) == Quality::kUncertain);
  CHECK(std::isnan(value(frames[3], SignalKind::kMv)));
  CHECK(quality(frames[3], SignalKind::kMv) == Quality::kBad);
  CHECK(value(frames[4], SignalKind::kMv) == 7.0);
  CHECK(value(frames[5], SignalKind::kMv) == Approx(4.5));
}

TEST_CASE("a CV is the last good row up to its time, else the last uncertain, if recent") {
  // Of the interval that ends at 10 s, 20 s, ...: which seconds are known, and how.
  const auto at_10 = [](const std::string& words) {  // of 1 ... 10 s: g, u, or none
    std::string text = "time,u,y,y.quality,sp,a\n0,1,1,good,1,1\n";
    for (int t = 1; t < 40; ++t) {
      const char word = t <= 10 ? words[static_cast<std::size_t>(t - 1)] : 'g';
      text += std::to_string(t) + ",1," + (word == '-' ? "" : std::to_string(t)) + ',' +
              (word == 'u' ? "uncertain" : "good") + ",1,1\n";
    }
    return read(text).frames.at(1);
  };
  CHECK(value(at_10("gggggggggg"), SignalKind::kCv) == 10.0);
  CHECK(value(at_10("ggggggg---"), SignalKind::kCv) == 7.0);
  CHECK(value(at_10("gggggggguu"), SignalKind::kCv) == 8.0);
  CHECK(quality(at_10("gggggggguu"), SignalKind::kCv) == Quality::kGood);
  CHECK(value(at_10("gggguuuu--"), SignalKind::kCv) == 8.0);
  CHECK(quality(at_10("gggguuuu--"), SignalKind::kCv) == Quality::kUncertain);
  CHECK(std::isnan(value(at_10("gggg------"), SignalKind::kCv)));
}

// A controller that moves u to 1, 2, 3 ... at 7, 17, 27 ... s.
TEST_CASE("intervals begin where the MVs move, and else with the first row") {
  std::string text = "time,u,y,sp,a\n", restless = text;
  for (int t = 0; t < 500; ++t) {
    const std::string rest = ',' + std::to_string(t) + ",1,1\n";
    text += std::to_string(t) + ',' + std::to_string((t + 3) / 10) + rest;
    restless += std::to_string(t) + ',' + std::to_string(t % 7) + rest;
  }
  const Read read = averaged_rows_test::read(text);
  CHECK(read.notices[0].find("begin where the MVs move") != std::string::npos);
  REQUIRE(read.frames.size() == 51);
  for (int k = 1; k < 51; ++k) {
    const Frame& frame = read.frames[static_cast<std::size_t>(k)];
    CHECK(frame.interval == k);
    CHECK(frame.source_time_ns == (10 * k - 3) * 1'000'000'000LL);
    CHECK(value(frame, SignalKind::kMv) == k);  // none is mixed with the next
    CHECK(value(frame, SignalKind::kCv) == 10 * k - 3);
  }
  CHECK(averaged_rows_test::read(restless).notices[0].find("MVs move") == std::string::npos);
}

TEST_CASE("gaps stay gaps, and rows that go back a little are left out") {
  std::string text = "time,u,y,sp,a\n";
  for (int t = 0; t < 100; ++t) {
    if (t >= 30 && t < 65) continue;
    text += std::to_string(t) + ",1," + std::to_string(t) + ",1,1\n";
    if (t == 80) text += "79,100,100,100,100\n";
  }
  const Read read = averaged_rows_test::read(text);
  REQUIRE(read.frames.size() == 7);
  CHECK(read.frames[2].interval == 2);
  CHECK(read.frames[3].interval == 6);
  // What was measured before 60 is not known; the next is the row of 70.
  CHECK(std::isnan(value(read.frames[3], SignalKind::kCv)));
  CHECK(value(read.frames[4], SignalKind::kCv) == 70.0);
  CHECK(value(read.frames[5], SignalKind::kMv) == 1.0);
  CHECK(read.notices.back() == "1 row left out, for the time goes back");
}

TEST_CASE("rows that are neither a sample time apart nor two to one are refused") {
  const auto refusal = [](const std::string& step, Purpose purpose) -> std::string {
    std::string text = "time,u,y,sp,a\n";
    for (int k = 0; k < 20; ++k) text += std::to_string(k * std::stod(step)) + ",1,1,1,1\n";
    try {
      const CsvReader reader(std::make_unique<std::istringstream>(text), "d.csv", unit_of("10"), {},
                             purpose);
    } catch (const config::InputError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(refusal("5", Purpose::kJudge).empty());
  CHECK(refusal("9.5", Purpose::kJudge).empty());
  CHECK(refusal("7", Purpose::kJudge).find("the rows are 7 s apart") != std::string::npos);
  CHECK(refusal("20", Purpose::kJudge).find("the rows are 20 s apart") != std::string::npos);
  // A conversion loses nothing.
  CHECK(refusal("1", Purpose::kKeep).find("the rows are 1 s apart") != std::string::npos);
}

}  // namespace mpm::files::averaged_rows_test
