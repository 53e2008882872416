#include "daemon/app/commands/topic_choice_options.hpp"

#include <string>

namespace mpm::app {

void add_topic_choice(CLI::App& command, bag::TopicChoice& choice, const std::string& description) {
  command.add_option("--topics", choice.names, description)->delimiter(',');
  command.add_option("--regex", choice.regex,
                     "the monitor's topics of whose names a part matches, as '_event|health'");
  command.add_option("--exclude-topics", choice.exclude, "but not these topics")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--exclude-regex", choice.exclude_regex, "nor those that it matches");
}

}  // namespace mpm::app
