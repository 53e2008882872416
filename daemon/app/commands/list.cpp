#include <iostream>
#include <memory>
#include <string>

#include "config/finding.hpp"
#include "daemon/app/commands/commands.hpp"
#include "daemon/bag/list_text.hpp"

namespace mpm::app {
namespace {

// 0, or 3 on bad input. What is cut off is no bad input here: it is told.
int run_list(const std::string& folder, bool json) {
  try {
    const std::vector<bag::ListedRecording> list = bag::list_recordings(folder);
    if (json)
      std::cout << bag::to_json(list).dump(-1, ' ', false,
                                           nlohmann::ordered_json::error_handler_t::replace)
                << '\n';
    else
      std::cout << bag::to_text(list);
    std::cout << std::flush;
    if (list.empty()) std::cerr << folder << ": there is no recording in this folder\n";
    return 0;
  } catch (const config::InputError& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
  const auto folder = std::make_shared<std::string>(".");
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "list",
      "Tell which recordings (MCAP) lie in a folder: name, start, length, size, messages, units, "
      "and whether each is whole");
  command->add_option("folder", *folder, "where to look; folders in it are recordings too")
      ->capture_default_str();
  command->add_flag("--json", *json, "print one JSON array");
  command->footer(
      "Examples:\n"
      "  mpm list /var/lib/mpm/recordings\n"
      "  mpm list /var/lib/mpm/ring/saved    what mpm record --snapshot saved\n"
      "Exit codes: 0 done, 3 no such folder");
  command->callback([folder, json, &exit_code] { exit_code = run_list(*folder, *json); });
}

}  // namespace mpm::app
