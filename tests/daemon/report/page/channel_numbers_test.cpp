#include "daemon/report/page/channel_numbers.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <variant>

#include "daemon/report/diagnosis/extended_unit.hpp"
#include "tests/daemon/report/identification/small_run.hpp"
#include "tests/daemon/report/sample_run.hpp"

namespace mpm::test {
namespace {

using namespace mpm::report;

const ChannelNumbers& of(const std::vector<ChannelNumbers>& all, int cv, int input) {
  for (const ChannelNumbers& each : all)
    if (each.cv == cv && each.input == input) return each;
  FAIL("no such channel");
  return all.front();
}

// The Shell plant: y3 / u3 is 7.20 e^{-0}/(19 s + 1), times in min; the sample run makes it 1.4
// times as strong, and the finding's interval is 1.381 to 1.424.
TEST_CASE("old and new are in the user's units, with the interval of the finding") {
  const std::vector<ChannelNumbers> all = channel_numbers(sample_run());
  const ChannelNumbers& changed = of(all, 2, 2);
  CHECK(changed.changed(1.0));
  CHECK(changed.gain.old_value == Approx(7.2));
  CHECK(changed.gain.new_value == Approx(1.4 * 7.2));
  CHECK(changed.gain.low == Approx(1.381 * 7.2));
  CHECK(changed.gain.high == Approx(1.424 * 7.2));
  CHECK(changed.time_constants.at(0).new_value == changed.time_constants.at(0).old_value);
  CHECK_FALSE(of(all, 1, 1).changed(1.0));
  // The input that is new has no old numbers, and the intervals of its finding.
  const ChannelNumbers& fresh = of(all, 0, 3);
  CHECK(std::isnan(fresh.gain.old_value));
  CHECK(fresh.gain.new_value == Approx(1.5));
  CHECK(fresh.gain.low == 1.41);
  CHECK(fresh.time_constants.at(0).high == 23.8);
}

TEST_CASE("an interval that does not hold the model's number is another explanation's") {
  DiagnosisRun run = sample_run(600);
  run.diagnosis.channels[0].gain_ratio = {&kGainRatio, 1.3, 1.2, 1.4};  // the model kept 1
  CHECK(std::isnan(of(channel_numbers(run), 0, 0).gain.low));
}

TEST_CASE("blocks before and behind a channel are part of its gain") {
  DiagnosisRun run = sample_run(600);
  const double plain = of(channel_numbers(run), 1, 0).gain.new_value;
  run.diagnosis.extended.output_blocks[1] = Scale{1.5};
  run.diagnosis.extended.input_blocks[0] = Polynomial{{0.8, 0.1}};
  // Of small moves around where the input mostly was, d of its origin: 0.8 + 2 * 0.1 d.
  std::vector<double> moved(run.recording.inputs.col(0).begin(), run.recording.inputs.col(0).end());
  std::sort(moved.begin(), moved.end());
  const double d = moved[moved.size() / 2] - run.diagnosis.extended.input_origin(0);
  REQUIRE(std::abs(d) > 0.01);
  CHECK(of(channel_numbers(run), 1, 0).gain.new_value == Approx(1.5 * (0.8 + 0.2 * d) * plain));
  // Of what differs on either side of a point, in the input's own units: the side it was mostly on.
  const double mostly = moved[moved.size() / 2];
  run.diagnosis.extended.input_origin(0) = 40.0;
  for (double& value : run.recording.inputs.col(0)) value += 40.0;
  run.diagnosis.extended.input_blocks[0] = TwoSided{1.2, 0.7, 40.0 + mostly - 0.01};
  CHECK(of(channel_numbers(run), 1, 0).gain.new_value == Approx(1.5 * 1.2 * plain));
  run.diagnosis.extended.input_blocks[0] = TwoSided{1.2, 0.7, 40.0 + mostly + 0.01};
  CHECK(of(channel_numbers(run), 1, 0).gain.new_value == Approx(1.5 * 0.7 * plain));
}

TEST_CASE("a lead is in the table, and two time constants have their intervals") {
  DiagnosisRun run = sample_run(600);
  const auto lead_of = [](DiagnosisRun& of_run, double lead_s) {
    for (ChannelSpec& channel : of_run.diagnosis.extended.channels)
      if (auto* tf = std::get_if<TransferFunction>(&channel.dynamics))
        if (channel.cv == 2 && channel.input == 2) tf->lead_s = lead_s;
  };
  CHECK_FALSE(of(channel_numbers(run), 2, 2).has_lead());
  lead_of(run, 4.5);
  const ChannelNumbers channel = of(channel_numbers(run), 2, 2);
  REQUIRE(channel.has_lead());
  CHECK(channel.lead.new_value == 4.5);
  const auto json = numbers_json({channel}, extended_unit(run.unit, run.diagnosis));
  CHECK(std::string(json["csv"]).find(",lead,s,0,4.5,") != std::string::npos);
  CHECK(std::string(json["rows"][0]["time_constant"]["new"]).find("lead 4.5 s") !=
        std::string::npos);
}

TEST_CASE("the table is a CSV that any tag survives") {
  DiagnosisRun run = sample_run(600);
  run.unit.cv[2].tag = "y,\"3";
  const auto json = numbers_json(channel_numbers(run), extended_unit(run.unit, run.diagnosis));
  const std::string csv = json["csv"];
  CHECK(csv.rfind("cv,input,number,unit,old,new,low,high\n", 0) == 0);
  CHECK(csv.find("\"y,\"\"3\",u3,gain,degC per m3/h,7.2,10.08,9.9432,10.2528\n") !=
        std::string::npos);
  CHECK(json["rows"].size() == 10);
}

TEST_CASE("an identified channel has its own intervals") {
  const std::vector<ChannelNumbers> all = channel_numbers(small_run());
  REQUIRE(all.size() == 1);
  CHECK(std::isnan(all[0].gain.old_value));
  CHECK(all[0].gain.new_value == Approx(2.0));
  CHECK(all[0].gain.high == 2.1);
  CHECK(all[0].time_constants.at(0).low == 7.0);
  CHECK(all[0].dead_time.low == 0.8);
}

// The unit file holds the pair's sampled form; the table says what the fit found.
TEST_CASE("a pair that overshoots has its time, damping and dead time") {
  IdentificationRun run = small_run();
  ChannelAnswer& answer = run.identification.channels[0];
  answer.dynamics = TransferFunction{2.0, {}, 0.0, 1.0, false};
  answer.pair = DampedPair{8.0, 0.5};
  run.identification.model.channels[0].dynamics = sampled(*answer.pair, 2.0, 1.0, 1.0);
  const std::vector<ChannelNumbers> all = channel_numbers(run);
  REQUIRE(all.size() == 1);
  CHECK(all[0].time_constants.at(0).new_value == 8.0);
  CHECK(all[0].time_constants.at(0).low == 7.0);
  CHECK(all[0].dead_time.new_value == 1.0);
  CHECK(all[0].dead_time.high == 1.2);
  const auto json = numbers_json(all, run.unit);
  CHECK(json["rows"][0]["time_constant"]["new"] == "8.0 s, damping 0.5");
  CHECK(json["csv"].get<std::string>().find("y,u,damping,,,0.5,,\n") != std::string::npos);
}

}  // namespace
}  // namespace mpm::test
