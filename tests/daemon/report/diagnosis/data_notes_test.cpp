#include "daemon/report/diagnosis/data_notes.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace mpm::test {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

constexpr Index kRows = 400;

template <class Value>
VectorXd column(Value value) {
  return VectorXd::NullaryExpr(kRows,
                               [&](Index k) { return value(k, static_cast<double>(k / 2)); });
}

VectorXd sound() {
  return column([](Index k, double) { return std::sin(0.7 * static_cast<double>(k)); });
}

/// Held for a row each; moves by 1, 1.01, 1.02 .., far less than what it does in all.
VectorXd held() {
  return column([](Index, double move) { return move + 0.005 * move * (move - 1.0); });
}

/// Held for a row each; moves by 2.01, 2.03 .., to and fro: about its s.d. of 2.
VectorXd held_coarsely() {
  return column(
      [](Index k, double move) { return (k / 2 % 2 == 0 ? 1.0 : -1.0) * (1.0 + 0.01 * move); });
}

/// Up and down the levels 0, 0.5 .. 0.5 `top`, two rows each. Of 20 moves per turn (top 10) the
/// s.d. is 0.5 sqrt(8.5), of 10 (top 5) 0.75.
VectorXd in_steps(int top) {
  return column(
      [top](Index, double move) { return 0.5 * std::abs(std::remainder(move, 2 * top)); });
}

/// Straight lines of ten rows, up and down.
VectorXd in_lines() {
  return column(
      [](Index k, double) { return std::abs(std::remainder(static_cast<double>(k), 20.0)); });
}

report::DiagnosisRun run_of(const VectorXd& cv, const VectorXd& mv, const VectorXd& dv) {
  report::DiagnosisRun run;
  run.unit.cv.resize(1);
  run.unit.cv[0].tag = "y";
  run.unit.cv[0].unit = "degC";
  run.unit.mv.resize(1);
  run.unit.mv[0].tag = "u";
  run.unit.mv[0].unit = "m3/h";
  run.unit.dv.resize(1);
  run.unit.dv[0].tag = "d";
  run.recording.cvs = cv;
  run.recording.inputs.resize(kRows, 2);
  run.recording.inputs << mv, dv;
  return run;
}

bool begins(const ordered_json& text, const std::string& with) {
  return text.get<std::string>().rfind(with, 0) == 0;
}

bool refuses(const ordered_json& note) {
  const std::string advice = note["advice"];
  return advice.find("no cause can be told from it") != std::string::npos;
}

}  // namespace

TEST_CASE("nothing is noted of data that nobody has touched") {
  CHECK(report::data_notes(run_of(sound(), sound(), sound())) == ordered_json::array());
}

TEST_CASE("every signal that a historian shows in is noted, CVs first") {
  const ordered_json notes = report::data_notes(run_of(held(), sound(), in_steps(10)));
  REQUIRE(notes.size() == 2);

  CHECK(notes[0]["tag"] == "y");
  CHECK(notes[0]["compressed"] == true);
  CHECK(notes[0]["interpolated"] == false);
  CHECK(notes[0]["deadband"].get<double>() == Approx(1.0));
  CHECK(notes[0]["quantum"] == 0.0);
  CHECK(notes[0]["held_share"] == 0.5);
  CHECK(notes[0]["beyond_use"] == false);
  CHECK(begins(notes[0]["advice"], "Held until it had moved by 1 degC. "));
  CHECK_FALSE(refuses(notes[0]));

  CHECK(notes[1]["tag"] == "d");
  CHECK(notes[1]["compressed"] == false);
  CHECK(notes[1]["deadband"] == 0.0);
  CHECK(notes[1]["quantum"].get<double>() == Approx(0.5));
  CHECK(notes[1]["beyond_use"] == false);
  CHECK(begins(notes[1]["advice"], "Moves in steps of 0.5, "));  // it has no unit
  CHECK_FALSE(refuses(notes[1]));
}

TEST_CASE("a CV that is read only now and then is noted, an input that moves only then is not") {
  VectorXd read = sound();
  for (Index k = 0; k < kRows; ++k) read(k) = read(k - k % 10);
  const ordered_json notes = report::data_notes(run_of(read, read, sound()));
  REQUIRE(notes.size() == 1);
  CHECK(notes[0]["tag"] == "y");
  CHECK(notes[0]["read_every"] == 10);
  CHECK(begins(notes[0]["advice"], "Read every 10 samples. "));

  DiagnosisRun run = run_of(read, read, sound());
  run.diagnosis.scores.resize(1);
  run.diagnosis.scores[0].judged = true;
  const ordered_json judged = report::data_notes(run);
  REQUIRE(judged.size() == 1);
  CHECK(begins(judged[0]["advice"], "Read every 10 samples, and judged at its readings"));
}

TEST_CASE("what is beyond use is said to be") {
  const ordered_json notes = report::data_notes(run_of(held_coarsely(), in_steps(5), in_lines()));
  REQUIRE(notes.size() == 3);
  for (const ordered_json& note : notes) {
    CHECK(note["beyond_use"] == true);
    CHECK(refuses(note));
  }
  CHECK(begins(notes[0]["advice"], "Held until it had moved by 2.01 degC. "));
  CHECK(begins(notes[1]["advice"], "Moves in steps of 0.5 m3/h, "));
  CHECK(notes[2]["interpolated"] == true);
  CHECK(notes[2]["compressed"] == true);
  CHECK(notes[2]["held_share"] == 0.0);
  CHECK(begins(notes[2]["advice"], "Straight lines between archived points. "));
}

}  // namespace mpm::test
