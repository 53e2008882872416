#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// What a command line takes, as data: read once from what is declared, told in several ways.
namespace mpm::cli {

struct OptionEntry {
  std::vector<std::string> names;  ///< "-c", "--config"; one without dashes where it stands alone
  std::string description;
  bool positional = false;
  bool takes_value = false;
  bool repeatable = false;
  std::vector<std::string> choices;  ///< the values that it may have; empty = any
};

struct CommandEntry {
  std::string name;
  std::string description;
  std::string footer;  ///< examples, exit codes
  std::vector<OptionEntry> options;
  std::vector<CommandEntry> commands;
};

[[nodiscard]] CommandEntry command_tree(const CLI::App& app);

/// `--man` and `--completion SHELL` for a program without commands: they print and are done.
void add_self_description(CLI::App& app, const std::string& version);

/// For "bash", "zsh" or "fish".
[[nodiscard]] std::string completion(const CommandEntry& root, const std::string& shell);
/// A script that completes the commands, options and values of `root`, and file names elsewhere.
[[nodiscard]] std::string bash_completion(const CommandEntry& root);
[[nodiscard]] std::string zsh_completion(const CommandEntry& root);
[[nodiscard]] std::string fish_completion(const CommandEntry& root);
/// A page of section 1 in roff, man(7).
[[nodiscard]] std::string man_page(const CommandEntry& root, const std::string& version);

}  // namespace mpm::cli
