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
#include "daemon/files/csv/tag_names.hpp"

using namespace mpm;
using namespace mpm::files;

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

TEST_CASE("Blanks at which no line may break are blanks, in names, times and values") {
  LineReader lines(std::make_unique<std::istringstream>(
                       "time,flow\u00A0rate,a\n"
                       "3/28/2026, 2:00:00\u202FPM\u2009,\u00A01.5\u2007,\u00E2\n"),
                   "a.csv");
  std::vector<Cell> cells;
  REQUIRE(lines.next());
  lines.split(',', cells);
  REQUIRE(cells.size() == 3);
  CHECK(cells[1].text == "flow rate");
  CHECK(folded("Flow\u00A0rate") == "flow rate");
  REQUIRE(lines.next());
  lines.split(',', cells);
  REQUIRE(cells.size() == 4);
  CHECK(cells[1].text == "2:00:00 PM");
  CHECK(cells[2].text == "1.5");
  CHECK(cells[3].text == "\u00E2");  // begins like one of them
}

TEST_CASE("A quoted cell goes on in the next lines, a quote that nothing closes does not") {
  const auto reader = [](const std::string& text) {
    LineReader made(std::make_unique<std::istringstream>(text), "a.csv");
    made.join_quoted();
    return made;
  };
  LineReader lines = reader("time,\"flow\r\n[m3/h]\",5\" pipe,\"a \"\"b\"\"\n\"\n1,2,3,4\n");
  std::vector<Cell> cells;
  for (int pass = 0; pass < 2; ++pass, lines.rewind()) {
    REQUIRE(lines.next());
    CHECK(lines.number() == 1);
    lines.split(',', cells);
    REQUIRE(cells.size() == 4);
    CHECK(cells[1].text == "flow [m3/h]");
    CHECK(cells[2].text == "5\" pipe");
    CHECK(cells[3].text == "a \"b\" ");
    REQUIRE(lines.next());
    CHECK(lines.number() == 4);
    CHECK(lines.text() == "1,2,3,4");
    CHECK_FALSE(lines.next());
  }
  std::string open = "time,a\n1,\"2\n";
  for (int row = 0; row < 100; ++row) open += "2,3\n";
  LineReader never = reader(open);
  REQUIRE(never.next());
  CHECK_THROWS_WITH(never.next(), "a.csv:2:3: error: a quote is not closed");
}

TEST_CASE("The delimiter is what the header uses most, quotes aside") {
  CHECK(find_delimiter("time,a,b") == ',');
  CHECK(find_delimiter("time;a;b") == ';');
  CHECK(find_delimiter("time\ta") == '\t');
  CHECK(find_delimiter("time,\"a;b;c\"") == ',');
  CHECK(find_delimiter("time|a|b") == '|');
  CHECK(find_delimiter("time,A|PV,A|SP|OP") == ',');  // an attribute of an element
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

TEST_CASE("Lines end where they end, whatever their length") {
  // Around the size of the pieces in which they come.
  for (const std::size_t length : {1U, 4094U, 4095U, 4096U, 4097U, 8190U, 8191U, 100'000U}) {
    CAPTURE(length);
    const std::string line(length, 'x');
    LineReader lines(std::make_unique<std::istringstream>(line + "\n" + line + "\nlast"), "d.csv");
    REQUIRE(lines.next());
    CHECK((lines.text() == line && lines.number() == 1 && lines.complete()));
    REQUIRE(lines.next());
    CHECK((lines.text() == line && lines.number() == 2 && lines.complete()));
    REQUIRE(lines.next());
    CHECK((lines.text() == "last" && lines.number() == 3 && !lines.complete()));
    CHECK_FALSE(lines.next());
  }
}

TEST_CASE("A line without an end is refused, and what follows it is read") {
  const std::string most(std::size_t{4} << 20U, 'x');
  LineReader lines(
      std::make_unique<std::istringstream>("a\n" + most + "\n" + most + most + "\nb\n"), "d.csv");
  REQUIRE(lines.next());
  REQUIRE(lines.next());
  CHECK(lines.text().size() == most.size());
  std::string error;
  try {
    static_cast<void>(lines.next());
  } catch (const config::InputError& refused) {
    error = refused.what();
  }
  CHECK(error == "d.csv:3:1: error: a line of more than 4 MiB");
  REQUIRE(lines.next());
  CHECK((lines.text() == "b" && lines.number() == 4));
  CHECK_FALSE(lines.next());
}
