#include "daemon/http/metrics.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/daemon/http/sample_board.hpp"

namespace mpm::http {
namespace {

/// By the format's own description (prometheus.io, exposition formats, 0.0.4): HELP and TYPE of a
/// family stand before its samples, and each series is there once.
struct Scrape {
  explicit Scrape(const std::string& text) {
    const std::regex head(R"(# (HELP|TYPE) ([a-z_]+) (.+))"),
        sample(R"(([a-z_]+)(\{(?:[a-z_]+="(?:[^"\\\n]|\\.)*",?)*\})? (\S+))");
    std::istringstream lines(text);
    std::string line, family;
    while (std::getline(lines, line)) {
      std::smatch found;
      CAPTURE(line);
      if (std::regex_match(line, found, head)) {
        if (found[1] == "TYPE") types[family = found[2]] = found[3];
        continue;
      }
      REQUIRE(std::regex_match(line, found, sample));
      CHECK(found[1] == family);
      CHECK(values.emplace(found[1].str() + found[2].str(), std::stod(found[3])).second);
    }
  }
  [[nodiscard]] double at(const std::string& series) const {
    CAPTURE(series);
    REQUIRE(values.contains(series));
    return values.at(series);
  }

  std::map<std::string, std::string> types;
  std::map<std::string, double> values;
};

TEST_CASE("a scrape has each unit's verdicts, alarms and counts") {
  test::SampleBoard sample;
  sample.health.frames = 4000;
  sample.health.late = 3;
  sample.health.source_time_ns = 1'700'000'000'500'000'000;
  sample.show(true);
  const Scrape scrape(metrics_text(sample.board, "mpmd test", 1'600'000'000'000'000'000));
  const std::string channel = R"(unit="column",mv="FIC-101",cv="AI-201")";
  CHECK(scrape.at("mpm_verdict{" + channel + R"(,verdict="mismatch"})") == 1.0);
  CHECK(scrape.at("mpm_verdict{" + channel + R"(,verdict="match"})") == 0.0);
  CHECK(scrape.at("mpm_effective_samples{" + channel + "}") == 400.0);
  CHECK(scrape.at("mpm_alarm_active{" + channel + "}") == 1.0);
  CHECK(scrape.at(R"(mpm_alarm_active{unit="column",mv="FIC-101",cv="AI-202"})") == 0.0);
  CHECK(scrape.at(R"(mpm_alarms{unit="column",state="unacknowledged"})") == 1.0);
  CHECK(scrape.at(R"(mpm_frames_total{unit="column"})") == 4000.0);
  CHECK(scrape.at(R"(mpm_samples_rejected_total{unit="column",reason="late"})") == 3.0);
  CHECK(scrape.at(R"(mpm_last_frame_timestamp_seconds{unit="column"})") == 1'700'000'000.5);
  CHECK(scrape.at(R"(mpm_health{unit="column",state="maintenance_required"})") == 1.0);
  CHECK(scrape.at(R"(mpm_health{unit="column",state="normal"})") == 0.0);
  CHECK(scrape.at(R"(mpm_service_factor_ratio{unit="column"})") == 0.75);
  CHECK(scrape.at(R"(mpm_build_info{version="mpmd test"})") == 1.0);
  CHECK(scrape.at("process_start_time_seconds") == 1.6e9);
  CHECK(scrape.at("process_resident_memory_bytes") > 1e6);
}

// prometheus.io, metric and label naming.
TEST_CASE("counters, and they alone, end in _total") {
  test::SampleBoard sample;
  sample.show(false);
  const Scrape scrape(metrics_text(sample.board, "mpmd test", 0));
  CHECK(scrape.types.size() > 15);
  for (const auto& [name, type] : scrape.types) {
    CAPTURE(name);
    CHECK(name.ends_with("_total") == (type == "counter"));
  }
}

TEST_CASE("a unit that was not seen yet has no series, and an odd tag no line of its own") {
  test::SampleBoard unseen;
  const Scrape nothing(metrics_text(unseen.board, "mpmd test", 0));
  CHECK(nothing.values.contains("process_cpu_seconds_total"));
  for (const auto& [series, value] : nothing.values) CHECK(series.find("unit=") == series.npos);

  test::SampleBoard sample;
  sample.show(true);
  sample.channels[0].mv = "a\"b\\c\nd";
  sample.feed().on_view({sample.channels, sample.alarms, sample.controller, sample.health,
                         sample.troubles, sample.performance});
  sample.fetch();
  const Scrape scrape(metrics_text(sample.board, "mpmd test", 0));
  CHECK(scrape.at(R"(mpm_verdict{unit="column",mv="a\"b\\c\nd",cv="AI-201",verdict="mismatch"})") ==
        1.0);
}

}  // namespace
}  // namespace mpm::http
