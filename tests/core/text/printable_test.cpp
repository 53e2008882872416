#include "core/text/printable.hpp"

#include <catch2/catch.hpp>

#include "core/text/utf8.hpp"

using mpm::find_invalid_utf8;
using mpm::printable;
using mpm::utf8_from_latin1;

TEST_CASE("what is ordinary text is printed as it is") {
  for (const char* text : {"", "FIC-101.PV", "Säurepumpe °C", "温度", "\U0001F525", "a\\b"})
    CHECK(printable(text) == text);
}

TEST_CASE("nothing in a name can begin a line or command a terminal") {
  CHECK(printable("a\nb\r\tc") == "a\\nb\\r\\tc");
  CHECK(printable("\x1b[2J\x7f") == "\\x1b[2J\\x7f");
  CHECK(printable(std::string("a\0b", 3)) == "a\\x00b");
  CHECK(printable("\u009b31m") ==
        "\\u{9b}31m");  // the control sequence introducer in one character
  CHECK(printable("\u202etxt.") == "\\u{202e}txt.");  // right to left from here
  CHECK(printable("\u2028") == "\\u{2028}");
}

TEST_CASE("what is no UTF-8 is shown byte by byte") {
  CHECK(printable("\xb0"
                  "C") == "\\xb0C");
  CHECK(printable("\xc3") == "\\xc3");                    // cut off
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");  // a surrogate
}

TEST_CASE("a long text is cut between its characters") {
  CHECK(printable(std::string(10, 'x'), 10) == std::string(10, 'x'));
  CHECK(printable(std::string(11, 'x'), 10) == std::string(10, 'x') + "...");
  CHECK(printable("xä", 2) == "x...");
  CHECK(printable("x\n", 2) == "x...");
  CHECK(printable(std::string(10'000'000, '\n')).size() == mpm::kLongestName + 3);
}

// The boundaries are those of RFC 3629, section 4.
TEST_CASE("UTF-8 is told from what is none") {
  constexpr std::size_t kValid = std::string_view::npos;
  for (const char* text : {"", "ab", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                           "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    CHECK(find_invalid_utf8(text) == kValid);
  for (const char* text :
       {"ab\x80", "ab\xc1\xbf", "ab\xe0\x9f\xbf", "ab\xed\xa0\x80", "ab\xf0\x8f\xbf\xbf",
        "ab\xf4\x90\x80\x80", "ab\xf5", "ab\xff", "ab\xe2\x82", "ab\xc3("})
    CHECK(find_invalid_utf8(text) == 2);
  CHECK(utf8_from_latin1("S\xe4ure 5 \xb0"
                         "C") == "Säure 5 °C");
  CHECK(utf8_from_latin1("\xff\x80") == "\u00ff\u0080");
}
