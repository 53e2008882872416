#include "daemon/report/identification/new_unit.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"
#include "tests/daemon/report/identification/small_run.hpp"

namespace mpm::test {

using report::new_unit_yaml;

TEST_CASE("all but the model stays as it was written, wherever the model stood") {
  const std::string head = "# Ours.\nunit: u\nsample_time: 1  # s\n", signals = kSignals;
  const std::string old = "model:\n  channels:\n  # old\n  - {cv: y, mv: v, gain: 9}\n\n";
  const std::string point = "operating_point: {u: 1}\n", tail = "# Alarms.\nalarms: {}\n";
  for (const std::string& text :
       {head + signals + tail, head + signals + old + tail, head + signals + tail + old + point}) {
    CAPTURE(text);
    const std::string yaml = new_unit_yaml(small_run(), text);
    CHECK(yaml.find("# Ours.\nunit: u\nsample_time: 1  # s\n" + signals) == 0);
    CHECK(yaml.find(tail) != std::string::npos);
    CHECK(yaml.find("old") == std::string::npos);
    const config::LoadResult back = config::load_unit_text(yaml, "new");
    REQUIRE(back.ok());
    REQUIRE(back.config.model.channels.size() == 1);
    CHECK(std::get<TransferFunction>(back.config.model.channels[0].dynamics).gain == 2.0);
    CHECK(back.config.model.input_origin(0) == 5.0);
  }
}

TEST_CASE("a unit file in one line is written as the program sees it") {
  const std::string yaml =
      new_unit_yaml(small_run(), "{unit: u, sample_time: 1, signals: {mv: [u, v], cv: [y]}}\n");
  const config::LoadResult back = config::load_unit_text(yaml, "new");
  REQUIRE(back.ok());
  CHECK(back.config.model.channels.size() == 1);
}

TEST_CASE("what is written can be read, whatever bytes the path of the data holds") {
  report::IdentificationRun run = small_run();
  run.data_file = "y\xFF/x.csv";
  const std::string text = "unit: u\nsample_time: 1\n" + std::string(kSignals);
  const std::string yaml = new_unit_yaml(run, text);
  CHECK(yaml.find("from y\\xff/x.csv.\n") != std::string::npos);
  CHECK(config::load_unit_text(yaml, "new").ok());
}

}  // namespace mpm::test
