#include "config/cli/slips.hpp"

#include <string_view>
#include <vector>

#include "config/suggest.hpp"
#include "core/text/printable.hpp"

namespace mpm::cli {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace

std::string slips_text(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  std::string name = at->get_name();
  for (const CLI::App* up = at->get_parent(); up != nullptr; up = up->get_parent())
    name = up->get_name() + " " + name;
  name.erase(0, name.find_first_not_of(' '));

  std::string text;
  bool command_wanted = !commands_of(*at).empty();
  for (const std::string& word : at->remaining()) {
    const std::string shown = "'" + printable(word) + "'";
    const std::string begin = (name.empty() ? "" : name + ": ") + "error: " + shown;
    if (word.rfind("--", 0) == 0 && word.size() > 2) {
      const std::string option = word.substr(0, word.find('='));
      text += begin + " is no option" + config::suggestion(option, options_of(*at)) + '\n';
    } else if (command_wanted) {
      text += begin + " is no command" + config::suggestion(word, commands_of(*at)) + '\n';
      break;  // what follows belongs to it
    }
  }
  return text;
}

}  // namespace mpm::cli
