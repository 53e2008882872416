#include "daemon/app/commands/time_choice_options.hpp"

namespace mpm::app {

void add_time_choice(CLI::App& command, files::TimeChoiceText& text) {
  command.add_option("--from", text.from,
                     "first time of the data that is used: seconds or ISO 8601, as they tell it");
  command.add_option("--until", text.until, "time from which on the data are not used any more");
  command
      .add_option("--exclude", text.exclude,
                  "A/B: leave out what the data hold from time A to time B (may be repeated)")
      ->take_all()
      ->expected(1);
}

}  // namespace mpm::app
