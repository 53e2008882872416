#include "daemon/history/trend/trend_svg.hpp"

#include <catch2/catch.hpp>
#include <regex>

#include "tests/daemon/history/sample_history.hpp"

namespace mpm::history {
namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++found;
  return found;
}

TEST_CASE("the picture of a trend is an SVG of its own with all that is known") {
  const Trend trend = test::changing_trend(30, 12, -20.0, 0.25);
  const std::string svg = to_svg(trend, find_changes(trend), nullptr);
  CHECK(svg.find("<svg xmlns=\"http://www.w3.org/2000/svg\"") == 0);
  CHECK(svg.substr(svg.size() - 7) == "</svg>\n");
  CHECK(count(svg, "<text") == count(svg, "</text>"));
  CHECK(count(svg, "<circle") == 2 * 30);        // prediction errors and gains
  CHECK(count(svg, "stroke-dasharray") == 2);    // since when
  CHECK(svg.find("href") == std::string::npos);  // fetches nothing
  CHECK(svg.find("u -&gt; y: gain") != std::string::npos);
  // Nothing is left of the picture, or right of it, or NaN.
  CHECK(svg.find("nan") == std::string::npos);
  const std::regex place("c?x[12]?=\"(-?[0-9.]+)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), place), end; at != end; ++at) {
    CHECK(std::stod((*at)[1]) >= 0.0);
    CHECK(std::stod((*at)[1]) <= 760.0);
  }
}

TEST_CASE("an input is named in full beside its panels") {
  Trend trend = test::changing_trend(30, 12, -20.0, 0.25);
  for (ChannelHead& channel : trend.head.channels) channel.mv = "21-FIC-4711.SP_REMOTE";
  const std::string svg = to_svg(trend, find_changes(trend), nullptr);
  CHECK(svg.find(">21-FIC-4711.SP_REMOTE</text>") != std::string::npos);
}

TEST_CASE("what is not known is left open in a picture") {
  const Trend trend = test::sample_trend(
      96,
      [](int, std::int64_t at) {
        Digest digest = test::sample_digest(at, kUnknown, 0.1);
        digest.channels[0].match = digest.channels[0].mismatch = 0;
        digest.cvs[0] = {"y", 0, kUnknown, 0, kUnknown, kUnknown};
        return digest;
      },
      Step::kHour);
  const std::string svg = to_svg(trend, find_changes(trend), nullptr);
  CHECK(count(svg, "cannot tell</text>") == 2);
  CHECK(count(svg, "<circle") == 0);
}

}  // namespace
}  // namespace mpm::history
