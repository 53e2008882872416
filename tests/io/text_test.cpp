#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "config/finding.hpp"
#include "config/load_unit.hpp"
#include "daemon/files/csv/cell.hpp"
#include "daemon/files/csv/csv_line.hpp"
#include "daemon/files/csv/csv_reader.hpp"
#include "daemon/files/times/time_text.hpp"

using namespace mpm;
using namespace mpm::files;

namespace {

std::int64_t ns(const std::string& text) {
  std::string problem;
  const auto time = parse_time(text, problem);
  CAPTURE(text, problem);
  REQUIRE(time);
  return *time;
}

bool is_time(const std::string& text) {
  std::string problem;
  return parse_time(text, problem).has_value();
}

}  // namespace

TEST_CASE("Seconds are exact to the nanosecond") {
  CHECK(ns("0") == 0);
  CHECK(ns("0.08") == 80'000'000);
  CHECK(ns("0,08") == 80'000'000);
  CHECK(ns("-1.5") == -1'500'000'000);
  CHECK(ns("+2.") == 2'000'000'000);
  CHECK(ns(".5") == 500'000'000);
  CHECK(ns("1e3") == 1'000'000'000'000);
  CHECK(ns("1.25E-3") == 1'250'000);
  // A double holds today's seconds only to about 200 ns.
  CHECK(ns("1714564800.123456789") == 1'714'564'800'123'456'789);
  CHECK(ns("0.0000000004") == 0);
  CHECK(ns("0.0000000005") == 1);
  CHECK(ns("0.1234567894999") == 123'456'789);
  CHECK(ns("000000000000000000000000001") == 1'000'000'000);
  CHECK(ns("1e-999") == 0);
  for (const char* text : {"", "-", ".", "1e", "1e+", "nan", "inf", "0x10", "1 2", "1e9999", "1e12",
                           "99999999999999999999", "12:00"})
    CHECK_FALSE(is_time(text));
}

TEST_CASE("ISO 8601 times with a zone are UTC") {
  CHECK(ns("1970-01-01T00:00:00Z") == 0);
  // date -u -d 2024-05-01T12:00:00Z +%s
  constexpr std::int64_t kMay = 1'714'564'800'000'000'000;
  CHECK(ns("2024-05-01T12:00:00Z") == kMay);
  CHECK(ns("2024-05-01 12:00:00Z") == kMay);
  CHECK(ns("2024-05-01T12:00Z") == kMay);
  CHECK(ns("2024-05-01T14:00:00+02:00") == kMay);
  CHECK(ns("2024-05-01T14:00:00+0200") == kMay);
  CHECK(ns("2024-05-01T06:30:00-05:30") == kMay);
  CHECK(ns("2024-05-01 12:00:00 UTC") == kMay);
  CHECK(ns("2024-05-01T12:00:00.25Z") == kMay + 250'000'000);
  CHECK(ns("2024-05-01T12:00:00,123456789Z") == kMay + 123'456'789);
  CHECK(ns("2024-02-29T00:00:00Z") == 1'709'164'800'000'000'000);
  CHECK(ns("1969-12-31T23:59:59Z") == -1'000'000'000);
  for (const char* text :
       {"2024-05-01", "2024-05-01T12:00:00", "2023-02-29T00:00:00Z", "2024-13-01T00:00:00Z",
        "2024-05-01T24:00:00Z", "2024-05-01T12:60:00Z", "2024-05-01T12:00:00X",
        "2024-05-01T12:00:00+25:00", "2024-05-01T12:00:00Zx", "9999-05-01T12:00:00Z",
        "2024-5-1T12:00:00Z", "2024-05-01T12:00:00.Z"})
    CHECK_FALSE(is_time(text));
}

TEST_CASE("Values and the words for none") {
  CHECK(parse_value("1.5", false) == 1.5);
  CHECK(parse_value("-1e-3", false) == -1e-3);
  CHECK(parse_value("1,5", true) == 1.5);
  for (const char* word : {"", "nan", "NaN", "NAN", "Bad", "bad", "BAD", "Bad Input", "No Data",
                           "I/O Timeout", "i/o timeout", "null"}) {
    CAPTURE(word);
    const auto value = parse_value(word, false);
    REQUIRE(value);
    CHECK(std::isnan(*value));
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  CHECK(parse_value("inf", false) == kInfinity);
  CHECK(parse_value("-1e999", false) == -kInfinity);
  CHECK(parse_value("1e-400", false) == 0.0);
  for (const char* word : {"1,5", "abc", "1.5x", "0x10", "--1", "1 000"})
    CHECK_FALSE(parse_value(word, false));
  CHECK_FALSE(parse_value("1,000,5", true));
}

TEST_CASE("The delimiter is what the header uses most, quotes aside") {
  CHECK(find_delimiter("time,a,b") == ',');
  CHECK(find_delimiter("time;a;b") == ';');
  CHECK(find_delimiter("time\ta") == '\t');
  CHECK(find_delimiter("time,\"a;b;c\"") == ',');
  CHECK(find_delimiter("time") == ',');
}

TEST_CASE("Quotes hold delimiters and quotes") {
  LineReader lines(std::make_unique<std::istringstream>("a,\"b,\"\"c\"\"\", \"\" ,d\n"), "x");
  REQUIRE(lines.next());
  std::vector<Cell> cells;
  lines.split(',', cells);
  REQUIRE(cells.size() == 4);
  CHECK(cells[1].text == "b,\"c\"");
  CHECK(cells[1].column == 3);
  CHECK(cells[2].text.empty());
  CHECK(cells[3].text == "d");
  CHECK(cells[3].column == 18);
}

TEST_CASE("No slip of the pen brings the reader down") {
  constexpr std::uint64_t kSeed = 20240503;
  std::mt19937_64 random(kSeed);
  const auto config = config::load_unit_text(
                          "unit: t\nsample_time: 1\nsignals: {mv: u1, cv: y1}\n"
                          "model: {channels: [{cv: y1, mv: u1, gain: 1}]}\n",
                          "u.yaml")
                          .config;
  const std::string originals[] = {
      "time,u1,u1.quality,y1\nunits,%,,m\n0,1.5,good,3\n1,2,64,\"4\"\n2,3,bad,nan\n",
      "time;u1;y1\n0,0;1,5;3\n1,0;2;4\n",
      "TagName,DateTime,Value,Quality\nu1,2024-05-01T12:00:00Z,1,192\ny1,2024-05-01T12:00:00Z,2,0\n"
      "u1,2024-05-01T12:00:01Z,3,192\ny1,2024-05-01T12:00:01Z,2,64\n"};
  int sound = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = originals[i % 3];
    for (std::size_t slips = 1 + random() % 5; slips > 0 && !text.empty(); --slips) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 10);
          break;
        case 2:
          text.insert(at, 1, ",;\"\n#\r-+.eZ"[random() % 11]);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 20));
      }
    }
    try {
      CsvReader csv(std::make_unique<std::istringstream>(text), "m.csv", config);
      Frame frame;
      while (csv.next(frame)) {
      }
      ++sound;
    } catch (const config::InputError& error) {
      if (error.finding().line < 1 || error.finding().column < 1) FAIL_CHECK(error.what());
    }
  }
  CHECK(sound > 100);
}
