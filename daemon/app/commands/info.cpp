#include "daemon/app/commands/commands.hpp"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "config/finding.hpp"
#include "daemon/app/commands/notices.hpp"
#include "daemon/app/commands/time_choice_options.hpp"
#include "daemon/app/commands/time_zone.hpp"
#include "daemon/bag/info_text.hpp"

namespace mpm::app {
namespace {

// 0, or 3 on bad input. A torn file is no bad input here: that it is torn is the information.
int run_info(const std::vector<std::string>& paths, const TimesText& times_text,
             const files::TimeChoiceText& choice, bool json) {
  try {
    const files::TimeStyle times = times_of(times_text);
    const bag::FileInfo info = bag::inspect(paths, times, files::TimeChoice(choice, times));
    tell_notices(info.notices, info.path);
    std::cout << (json ? to_json(info).dump(-1, ' ', false,
                                            nlohmann::ordered_json::error_handler_t::replace) +
                             "\n"
                       : to_text(info))
              << std::flush;
    return 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
  auto paths = std::make_shared<std::vector<std::string>>();
  auto times = std::make_shared<TimesText>();
  auto choice = std::make_shared<files::TimeChoiceText>();
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("info",
                         "Tell what a recording (MCAP) or a CSV file holds: topics, units, "
                         "span, gaps, qualities, and whether it is whole");
  command
      ->add_option(
          "file", *paths,
          "CSV in any historian layout, or MCAP recording; several of those, or a folder of "
          "them, are one")
      ->required();
  add_time_choice(*command, *choice);
  add_times(*command, *times);
  command->add_flag("--json", *json, "print one JSON object");
  command->footer("Example:\n  mpm info night.mcap");
  command->callback([paths, times, choice, json, &exit_code] {
    exit_code = run_info(*paths, *times, *choice, *json);
  });
}

}  // namespace mpm::app
