#include "daemon/live/unit_samples.hpp"

#include <catch2/catch.hpp>

#include "config/load_unit.hpp"
#include "daemon/live/sample_log.hpp"

namespace mpm::live {
namespace {

std::string unit_text(const std::string& cv, const std::string& gain) {
  return "unit: toy\nsample_time: 1.0\nsignals: {mv: [u1, u2], cv: [" + cv +
         "]}\nmodel:\n  channels:\n    - {cv: y1, mv: u1, gain: " + gain +
         ", time_constants: [5]}\n    - {cv: y1, mv: u2, gain: 1, time_constants: [5]}\n";
}

std::string meaning(const std::string& text) {
  const config::LoadResult loaded = config::load_unit_text(text, "toy.yaml");
  CAPTURE(text);
  REQUIRE(loaded.ok());
  return meaning_of(loaded.config);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("samples keep their meaning whatever the monitor is asked of them") {
  const std::string text = unit_text("y1", "2");
  CHECK(meaning(text) == meaning(text + "monitor: {memory: 8000}\n"));
  CHECK(meaning(text) == meaning(text + "dds: {domain: 7}\n"));
  // Its predictions are made anew from the samples.
  CHECK(meaning(text) == meaning(unit_text("y1", "3")));
}

TEST_CASE("samples of other signals, at another pace or of another model mean something else") {
  const std::string text = unit_text("y1", "2");
  CHECK(meaning(text) != meaning(replaced(text, "[u1, u2]", "[u2, u1]")));
  CHECK(meaning(text) != meaning(replaced(text, "[u1, u2]", "[u1, u2, u3]")));
  CHECK(meaning(text) != meaning(replaced(text, "sample_time: 1.0", "sample_time: 2.0")));
  const std::string predicted = "{tag: y1, prediction: p1}";
  CHECK(meaning(text) != meaning(unit_text(predicted, "2")));
  CHECK(meaning(unit_text(predicted, "2")) == meaning(unit_text(predicted, "2")));
  CHECK(meaning(unit_text(predicted, "2")) != meaning(unit_text(predicted, "3")));
}

TEST_CASE("a state belongs to a unit file, whatever in it has changed") {
  const auto owner = [](const std::string& text) {
    const config::LoadResult loaded = config::load_unit_text(text, "toy.yaml");
    REQUIRE(loaded.ok());
    return owner_of_state(loaded.config);
  };
  const std::string text = unit_text("y1", "2");
  CHECK(owner(text) == owner(text));
  CHECK(owner(text) != owner(unit_text("y1", "3")));
  CHECK(owner(text) != owner(text + "monitor: {memory: 8000}\n"));
  CHECK(owner(text) != owner(text + "alarms: {on_delay: 7}\n"));
}

TEST_CASE("states come the more often the more there is to judge behind them") {
  const auto samples = [](const std::string& plant, std::size_t units) {
    const config::LoadResult loaded =
        config::load_unit(MPM_SOURCE_DIR "/config/plants/" + plant + ".yaml");
    REQUIRE(loaded.ok());
    return samples_of(loaded.config, units, "samples");
  };
  const UnitSamples small = samples("shell3x3", 1), large = samples("shell7x5", 1),
                    many = samples("shell7x5", 50);
  CHECK(small.folder == "samples/shell");
  CHECK(small.keep >= large.keep);
  CHECK(large.keep > many.keep);
  CHECK(small.files_between_states > large.files_between_states);
  CHECK(small.files_between_states <= SampleLog::kFiles / 4);
  CHECK(many.files_between_states >= 1);
}

}  // namespace
}  // namespace mpm::live
