#include "daemon/report/terminal/terminal_text.hpp"

#include <catch2/catch.hpp>

namespace mpm::report {

TEST_CASE("tags are cut in the middle by characters, not by bytes") {
  CHECK(shortened("FIC-101", 7) == "FIC-101");
  CHECK(shortened("FIC-101.PV", 7) == "FIC..PV");
  CHECK(shortened("K\u00e4ltem\u00e4\u00dfig", 6) == "K\u00e4..ig");
  CHECK(columns_of("K\u00e4lte") == 5);
  CHECK(padded("K\u00e4lte", 7) == "K\u00e4lte  ");
  CHECK(wrapped("about 41 % of it", 1, 11) == " about 41 %\n   of it\n");
}

TEST_CASE("sentences of a text are wrapped behind their indent, and tables stay") {
  const std::string text =
      "A head that is longer than that.\n\n  1. gain of u\n     y answers u 41 % more than told\n"
      "    CV     before     after   that is far too wide\n";
  CHECK(sentences_wrapped(text, 24) ==
        "A head that is longer\n  than that.\n\n  1. gain of u\n     y answers u 41 %\n"
        "       more than told\n    CV     before     after   that is far too wide\n");
  CHECK(sentences_wrapped(text, 80) == text);
  CHECK(sentences_wrapped("", 80).empty());
}

}  // namespace mpm::report
