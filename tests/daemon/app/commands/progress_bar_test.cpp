#include "daemon/app/commands/progress_bar.hpp"

#include <catch2/catch.hpp>

using namespace mpm::app;

TEST_CASE("A progress bar is narrower than the terminal, so that no line breaks") {
  CHECK(progress_text("reading", 50, 200) ==
        "reading [" + std::string(20, '#') + std::string(20, '.') + "] 50 %");
  CHECK(progress_text("reading", 100, 80).size() < 80);
  CHECK(progress_text("reading", 50, 30) == "reading [######.......] 50 %");
  for (std::size_t width = 7; width < 100; ++width) {
    CAPTURE(width);
    CHECK(progress_text("reading", 100, width).size() < width);
    CHECK(progress_text("reading", 100, width).find("100 %") != std::string::npos);
  }
}
