#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "config/load_unit.hpp"
#include "tests/system/process.hpp"

namespace mpm::test::import_test {
namespace {

struct Bench {
  TemporaryFolder folder;

  Bench() {
    write_file(file("unit.yaml"),
               "unit: small\nsample_time: 10\n"
               "signals: {mv: [{tag: u, unit: m3/h}, v], dv: d, cv: [{tag: y, unit: degC}, z]}\n"
               "operating_point: {u: 5, y: 70}\n");
  }
  std::string file(const std::string& name) const { return folder.file(name); }
  int import(const std::string& name, const std::string& text) const {
    write_file(file(name), text);
    return run({"mpm", "import", file(name), "--config", file("unit.yaml"), "--out",
                file("new.yaml")},
               file("out"), file("err"))
        .value_or(-1);
  }
  std::string refusal(const std::string& name, const std::string& text) const {
    CHECK(import(name, text) == 3);
    CHECK_FALSE(std::filesystem::exists(file("new.yaml")));
    const std::string said = read_file(file("err"));
    return said.rfind(file(name) + ":", 0) == 0 ? said.substr(file(name).size() + 1) : said;
  }
  ModelSpec model() const {
    const config::LoadResult loaded = config::load_unit(file("new.yaml"));
    REQUIRE(loaded.ok());
    return loaded.config.model;
  }
};

/// 2 (1 - e^{-(t - 25) / 60}) at t = 10 `first`, 20, ..., and a response that swings.
std::string rows(int first) {
  std::string lag = "y,u", swing = "z,d";
  for (int k = first; k < 60; ++k) {
    const double t = 10.0 * k;
    lag += ',' + std::to_string(t > 25.0 ? 2.0 * (1.0 - std::exp(-(t - 25.0) / 60.0)) : 0.0);
    swing += ',' + std::to_string(1.0 - std::exp(-t / 100.0) * std::cos(t / 30.0));
  }
  return lag + '\n' + swing + '\n';
}

}  // namespace

TEST_CASE("step responses become a model, in few numbers where these say the same") {
  const Bench bench;
  std::string header = "cv,mv";
  for (int k = 1; k < 60; ++k) header += ',' + std::to_string(10 * k);
  // From 0 without times; from one sample on where that is said, or where 0 cannot be meant.
  const std::string text = GENERATE_COPY(rows(0), header + '\n' + rows(1), "cv,mv\n" + rows(1));
  REQUIRE(bench.import("dmc.csv", text) == 0);
  const ModelSpec model = bench.model();
  REQUIRE(model.channels.size() == 2);
  const auto* lag = std::get_if<TransferFunction>(&model.channels[0].dynamics);
  REQUIRE(lag != nullptr);
  CHECK(lag->gain == Approx(2.0).epsilon(1e-3));
  REQUIRE(lag->time_constants_s.size() == 1);
  CHECK(lag->time_constants_s[0] == Approx(60.0).epsilon(2e-3));
  CHECK(lag->dead_time_s == Approx(25.0).margin(0.1));
  const auto* swing = std::get_if<StepResponse>(&model.channels[1].dynamics);
  REQUIRE(swing != nullptr);
  CHECK(model.channels[1].cv == 1);
  CHECK(model.channels[1].input == 2);
  REQUIRE(swing->values.size() == 60);
  CHECK(swing->values[3] == Approx(1.0 - std::exp(-0.3) * std::cos(1.0)).margin(1e-6));
  CHECK(model.input_origin(0) == 5.0);
  CHECK(model.output_origin(0) == 70.0);
  const std::vector<std::string> said = lines_of(read_file(bench.file("out")));
  REQUIRE(said.size() == 3);
  CHECK(said[0].find("u -> y: gain 2, time constant 60 s, dead time 25 s; off by at most") == 0);
  CHECK(said[1].find("d -> z: kept as a step response of 60 values") == 0);
}

TEST_CASE("a table that does not fit the unit is refused with its place") {
  const Bench bench;
  const auto said = [&](const std::string& text, const std::string& place_and_part) {
    const std::string refusal = bench.refusal("dmc.csv", text);
    INFO(refusal);
    const std::size_t space = place_and_part.find(' ');
    CHECK(refusal.rfind(place_and_part.substr(0, space), 0) == 0);
    CHECK(refusal.find(place_and_part.substr(space + 1)) != std::string::npos);
  };
  said("cv,mv\ny,u,0,1\ny,w,0,1\n", "3:3: 'w' is no mv or dv of unit 'small'");
  said("x,u,0,1\n", "1:1: 'x' is no cv of unit 'small'");
  said("y,u,0,1,2\ny,v,0,1\n", "2:7: this row has 2 coefficients, line 1 has 3");
  said("y,u,0,one\n", "1:7: 'one' is no number");
  said("y,u,0,,2\n", "1:7: '' is no number");
  said("y,u,0,1\ny,u,0,2\n", "2:1: the first is in line 1");
  said("cv,mv,0,20,40\ny,u,0,1,2\n", "1:9: should be 10 s: the unit's sample_time is 10 s");
  said("cv,mv,0,10,x\ny,u,0,1,2\n", "1:12: 'x' is no time");
  said("y,u\n", "1:1: the coefficients");
  said("cv,mv\n", "2:1: holds no step response");
  said("y,u,0,0\n", " all coefficients are 0");
}

TEST_CASE("units in a table of step responses are compared with the unit file's") {
  const Bench bench;
  const std::string head = "cv,mv,cv_unit,mv_unit,0,10,20,30\n";
  REQUIRE(bench.import("dmc.csv", head + "y,u,degC,m^3/h,0,1,2,2\nz,v,,,0,1,1,1\n") == 0);
  CHECK(bench.model().channels.size() == 2);
  REQUIRE(bench.import("dmc.csv", head + "z,v,bar,%,0,1,2,2\n") == 0);
  CHECK(read_file(bench.file("err")).find("the unit of 'z', bar, is not compared") !=
        std::string::npos);
  std::filesystem::remove(bench.file("new.yaml"));
  CHECK(bench.refusal("dmc.csv", head + "y,u,degC,t/h,0,1,2,2\n")
            .find("2:10: error: 'u' is in m3/h in the unit file, not in t/h") == 0);
  CHECK(bench.refusal("dmc.csv", "cv,mv,mv_unit,0,5\ny,u,m3/h,0,1\n")
            .find("1:17: error: should be 10 s: the unit's sample_time is 10 s") == 0);
}

TEST_CASE("a state space may come as a folder of matrices") {
  const Bench bench;
  std::filesystem::create_directory(bench.file("m"));
  const auto put = [&](const std::string& name, const std::string& text) {
    write_file(bench.file("m/" + name + ".csv"), text);
  };
  const auto import = [&] {
    return run({"mpm", "import", bench.file("m"), "--config", bench.file("unit.yaml"), "--out",
                bench.file("new.yaml")},
               bench.file("out"), bench.file("err"))
        .value_or(-1);
  };
  put("A", "# sample_time: 10 s\n0.9,0\n0.1,8e-1\n");
  put("B", "u;v;d\n1;0;0\n0;2,5;1\n");
  put("C", "y,1,0\nz,0,1\n");
  put("x0", "0\n1\n");
  REQUIRE(import() == 0);
  const ModelSpec model = bench.model();
  REQUIRE(model.state_space);
  CHECK(model.state_space->a(1, 0) == 0.1);
  CHECK(model.state_space->b(1, 1) == 2.5);
  CHECK(model.state_space->c(1, 1) == 1.0);
  CHECK(model.state_space->d.isZero(0.0));
  CHECK(model.state_space->x0(1) == 1.0);
  std::filesystem::remove(bench.file("new.yaml"));

  const auto said = [&](const std::string& part) {
    CHECK(import() == 3);
    CHECK_FALSE(std::filesystem::exists(bench.file("new.yaml")));
    INFO(read_file(bench.file("err")));
    CHECK(read_file(bench.file("err")).find(part) != std::string::npos);
  };
  put("B", "v;u;d\n1;0;0\n0;2,5;1\n");
  said("B.csv:1:1: error: 'v' stands where the unit file has 'u'");
  put("B", "1,0\n0,2\n");
  said("B.csv: error: must be 2 x 3 (states x MVs and DVs), not 2 x 2");
  put("B", "1,0,0\n0,two,1\n");
  said("B.csv:2:3: error: 'two' is no number");
  put("B", "1,0,0\n0,2,1\n");
  put("A", "# sample_time: 1 s\n0.9,0\n0.1,0.8\n");
  said("A.csv:1:1: error: the unit's sample_time is 10 s");
  std::filesystem::remove(bench.file("m/A.csv"));
  said("A.csv");
}

TEST_CASE("a state space becomes the model, checked against the unit") {
  const Bench bench;
  const std::string good =
      "{\"A\": [[0.9, 0], [0, 0.8]], \"B\": [[1, 0, 0], [0, 2, 1]],\n"
      " \"C\": [[1, 0], [0, 1]], \"x0\": [0, 1]";
  REQUIRE(bench.import("m.json", good + ", \"sample_time\": 10, \"inputs\": [\"u\", \"v\", \"d\"], "
                                        "\"outputs\": [\"y\", \"z\"]}") == 0);
  const ModelSpec model = bench.model();
  REQUIRE(model.state_space);
  CHECK(model.state_space->a(1, 1) == 0.8);
  CHECK(model.state_space->b(1, 2) == 1.0);
  CHECK(model.state_space->x0(1) == 1.0);
  std::filesystem::remove(bench.file("new.yaml"));
  CHECK(bench.refusal("m.json", good + ", \"sample_time\": 1}")
            .find("the unit's sample_time is 10 s") != std::string::npos);
  CHECK(bench.refusal("m.json", good + ", \"inputs\": [\"v\", \"u\", \"d\"]}")
            .find("'v' stands where the unit file has 'u'") != std::string::npos);
  CHECK(bench.refusal("m.json", "{\"A\": [[1]], \"B\": [[1, 2]],\n \"C\": [[1], [1]]}")
            .find("must be 1 x 3 (states x MVs and DVs), not 1 x 2") != std::string::npos);
  CHECK(bench.refusal("m.json", "{\"A\": [[1, 2], [3]], \"B\": [[1]], \"C\": [[1]]}")
            .rfind("1:", 0) == 0);
}

}  // namespace mpm::test::import_test
