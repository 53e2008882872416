#include <catch2/catch.hpp>
#include <sstream>

#include "config/load_unit.hpp"

namespace mpm::test {
namespace {

const std::string kSignals =
    "unit: u\nsample_time: 2\nsignals:\n  mv: [u1, u2]\n  dv: [d1]\n  cv: [y1, y2]\n";

config::LoadResult load(const std::string& more) {
  return config::load_unit_text(kSignals + more, "u.yaml", config::ModelNeed::kMayBeMissing);
}

std::string findings(const config::LoadResult& result) {
  std::string text;
  for (const config::Finding& finding : result.findings) text += config::format(finding) + '\n';
  return text;
}

}  // namespace

TEST_CASE("a unit without a model is refused but by who makes one") {
  for (const std::string model : {"", "model:\n", "model: {}\n"}) {
    CAPTURE(model);
    CHECK(findings(load(model)).empty());
    CHECK_FALSE(load(model).config.has_model());
    CHECK_FALSE(config::load_unit_text(kSignals + model, "u.yaml").ok());
  }
}

TEST_CASE("what the user knows of channels is read and printed") {
  const config::LoadResult result = load(
      "identify:\n  channels:\n"
      "    - {cv: y1, mv: u1, sign: \"+\"}\n"
      "    - {cv: y1, mv: u2, relation: none}\n"
      "    - {cv: y2, dv: d1, sign: -, dead_time: 12}\n"
      "    - {cv: y2, mv: u1, integrating: true}\n"
      "    - {cv: y2, mv: u2, integrating: false}\n");
  CHECK(findings(result).empty());
  const std::vector<ChannelHint> expected = {{0, 0, false, 1, {}},
                                             {0, 1, true, 0, {}},
                                             {1, 2, false, -1, 12.0},
                                             {1, 0, false, 0, {}, true},
                                             {1, 1, false, 0, {}, false}};
  CHECK(result.config.identify == expected);
  std::ostringstream out;
  config::print_unit(result.config, out);
  const config::LoadResult back =
      config::load_unit_text(out.str(), "printed", config::ModelNeed::kMayBeMissing);
  CHECK(back.config.identify == expected);
}

TEST_CASE("mistakes of the section are told at their place") {
  const auto check = [](const std::string& item, const std::string& message) {
    CAPTURE(item);
    CHECK(findings(load("identify:\n  channels:\n    - " + item + "\n")).find(message) !=
          std::string::npos);
  };
  check("{cv: y1, mv: u1, sing: \"+\"}", "u.yaml:9:24: error: ");
  check("{cv: y1, mv: u1, sign: up}", "must be \"+\" or \"-\", not 'up'");
  check("{cv: y1, mv: u1}", "says nothing of its channel");
  check("{cv: y1, mv: u1, relation: some}", "must be none");
  check("{cv: y1, mv: u1, relation: none, sign: \"+\"}", "neither sign nor dead time");
  check("{cv: y1, mv: u1, relation: none, integrating: true}", "does not integrate");
  check("{cv: y1, mv: u1, integrating: maybe}", "u.yaml:9:37: error: ");
  check("{cv: y1, mv: u1, dead_time: -3}", "u.yaml:9:35: error: ");
  check("{cv: y9, mv: u1, sign: \"+\"}", "y9");
  check("{cv: y1, mv: u1, sign: \"+\"}\n    - {cv: y1, mv: u1, sign: \"-\"}",
        "u.yaml:10:7: error: identify.channels[1]: the same channel as in line 9");
  CHECK_FALSE(load("identify: {chanels: []}\n").ok());
}

}  // namespace mpm::test
