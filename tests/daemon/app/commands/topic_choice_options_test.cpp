#include "daemon/app/commands/topic_choice_options.hpp"

#include <catch2/catch.hpp>

namespace mpm::test::topic_choice_options_test {
namespace {

using Texts = std::vector<std::string>;

bag::TopicChoice parsed(const std::string& arguments) {
  CLI::App command;
  bag::TopicChoice choice;
  app::add_topic_choice(command, choice, "which");
  command.parse(arguments);
  return choice;
}

TEST_CASE("topics are listed with commas, in one option or several") {
  const bag::TopicChoice choice = parsed(
      "--exclude-topics a,b --topics mpm/mv,mpm/cv --exclude-topics c --regex x --exclude-regex y");
  CHECK(choice.names == Texts{"mpm/mv", "mpm/cv"});
  CHECK(choice.regex == "x");
  CHECK(choice.exclude == Texts{"a", "b", "c"});
  CHECK(choice.exclude_regex == "y");
}

TEST_CASE("without options there is no choice") {
  const bag::TopicChoice choice = parsed("");
  CHECK(choice.names.empty());
  CHECK(choice.regex.empty());
  CHECK(choice.exclude.empty());
  CHECK(choice.exclude_regex.empty());
}

}  // namespace
}  // namespace mpm::test::topic_choice_options_test
