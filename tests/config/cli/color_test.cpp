#include "config/cli/color.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <cstdlib>

using namespace mpm::cli;

TEST_CASE("the option --no-color of a command says what NO_COLOR says, before the command runs") {
  unsetenv("NO_COLOR");
  bool refused = false;
  for (const bool given : {false, true}) {
    CLI::App app;
    CLI::App* command = app.add_subcommand("detect");
    add_no_color(*command);
    command->callback([&refused] { refused = color_refused(); });
    app.parse(given ? "detect --no-color" : "detect");
    CHECK(refused == given);
  }
  setenv("NO_COLOR", "", 1);  // empty, it says nothing
  CHECK_FALSE(color_refused());
  setenv("NO_COLOR", "1", 1);
  CHECK(color_refused());
  unsetenv("NO_COLOR");
}
