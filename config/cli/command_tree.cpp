#include "config/cli/command_tree.hpp"

namespace mpm::cli {
namespace {

// Of CLI11's name of a type, such as `TEXT:{auto,json,csv}`.
std::vector<std::string> choices_in(const std::string& type) {
  std::vector<std::string> choices;
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::string word;
  for (std::size_t i = begin + 1; i <= end; ++i) {
    if (i < end && type[i] != ',') {
      word += type[i];
    } else {
      choices.push_back(word);
      word.clear();
    }
  }
  return choices;
}

OptionEntry entry_of(const CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  entry.positional = !option.nonpositional();
  if (entry.positional) entry.names.push_back(option.get_name());
  entry.description = option.get_description();
  entry.takes_value = option.get_items_expected_max() > 0;
  entry.repeatable = option.get_items_expected_max() > 1;
  entry.choices = choices_in(option.get_type_name());
  return entry;
}

}  // namespace

CommandEntry command_tree(const CLI::App& app) {
  CommandEntry entry{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) entry.options.push_back(entry_of(*option));
  for (const CLI::App* command : app.get_subcommands(nullptr))
    entry.commands.push_back(command_tree(*command));
  return entry;
}

}  // namespace mpm::cli
