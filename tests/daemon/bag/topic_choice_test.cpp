#include "daemon/bag/topic_choice.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace mpm::bag {
namespace {

using Topics = std::set<std::string>;

const std::vector<std::string> kDefault = {"mpm/mv", "mpm/cv", "mpm/dv"};

std::string refusal(const TopicChoice& choice) {
  try {
    static_cast<void>(chosen_topics(choice, kDefault));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("topics are chosen by name and by pattern, and excluded last") {
  CHECK(chosen_topics({}, kDefault) == Topics{"mpm/mv", "mpm/cv", "mpm/dv"});
  CHECK(chosen_topics({{"mpm/mv", "theirs"}, "", {}, ""}, kDefault) == Topics{"mpm/mv", "theirs"});
  CHECK(chosen_topics({{"theirs"}, "^mpm/[cd]v$", {}, ""}, kDefault) ==
        Topics{"mpm/cv", "mpm/dv", "theirs"});
  CHECK(chosen_topics({{}, "alarm", {}, ""}, kDefault) ==
        Topics{"mpm/alarm", "mpm/alarm_event", "mpm/controller_alarm"});
  CHECK(chosen_topics({{}, "alarm", {"mpm/alarm"}, ""}, kDefault) ==
        Topics{"mpm/alarm_event", "mpm/controller_alarm"});
  CHECK(chosen_topics({{}, "", {"mpm/health"}, ""}, kDefault) ==
        Topics{"mpm/mv", "mpm/cv", "mpm/dv"});
  CHECK(chosen_topics({{}, "", {}, "[mc]v"}, kDefault) == Topics{"mpm/dv"});
}

TEST_CASE("a choice that means nothing is refused with its option's name") {
  CHECK(refusal({{}, "mpm/(", {}, ""}).starts_with("--regex: 'mpm/(' is no regular expression: "));
  CHECK(refusal({{}, "", {}, "["}).starts_with("--exclude-regex: '[' is no regular expression: "));
  CHECK(refusal({{}, std::string(257, 'a'), {}, ""}) == "--regex: longer than 256 letters");
  CHECK(refusal({{}, "valve", {}, ""}) == "--regex: 'valve' matches no topic of the monitor");
  CHECK(refusal({{}, "", {"mpm/mw"}, ""}) == "--exclude-topics: there is no topic 'mpm/mw'");
  CHECK(refusal({{}, "", {}, "mpm"}) == "all topics chosen are excluded");
  // More states than the library takes, on any machine.
  CHECK_FALSE(refusal({{}, "((a{100}){100}){100}", {}, ""}).empty());
}

}  // namespace mpm::bag
