#include "daemon/app/commands/time_choice_options.hpp"

#include <catch2/catch.hpp>

namespace mpm::test::time_choice_options_test {
namespace {

using Texts = std::vector<std::string>;

files::TimeChoiceText parsed(const std::string& arguments) {
  CLI::App command;
  files::TimeChoiceText text;
  app::add_time_choice(command, text);
  command.parse(arguments);
  return text;
}

TEST_CASE("times are taken as they were typed") {
  const files::TimeChoiceText text =
      parsed("--until 2024-01-01T01:00:00+01:00 --exclude 3/4 --from 50 --exclude 1/2");
  CHECK(text.from == "50");
  CHECK(text.until == "2024-01-01T01:00:00+01:00");
  CHECK(text.exclude == Texts{"3/4", "1/2"});
}

TEST_CASE("without a choice of time all texts are empty") {
  const files::TimeChoiceText text = parsed("");
  CHECK(text.from.empty());
  CHECK(text.until.empty());
  CHECK(text.exclude.empty());
}

TEST_CASE("an option without its time is refused") {
  CHECK_THROWS_AS(parsed("--until"), CLI::ArgumentMismatch);
  CHECK_THROWS_AS(parsed("--exclude"), CLI::ArgumentMismatch);
  CHECK_THROWS_AS(parsed("--from"), CLI::ArgumentMismatch);
}

}  // namespace
}  // namespace mpm::test::time_choice_options_test
