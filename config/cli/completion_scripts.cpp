#include <string>

#include "config/cli/command_tree.hpp"

namespace mpm::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

/// In single quotes, as all three shells read it.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// `text` with a backslash before each of `marks`.
std::string escaped(const std::string& text, const char* marks) {
  std::string result;
  for (const char c : text) {
    if (std::string(marks).find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string flags_of(const CommandEntry& command) {
  std::string text;
  for (const OptionEntry& option : command.options)
    if (!option.positional) text += (text.empty() ? "" : " ") + joined(option.names, " ");
  return text;
}

const OptionEntry* positional_of(const CommandEntry& command) {
  for (const OptionEntry& option : command.options)
    if (option.positional) return &option;
  return nullptr;
}

// Values after their options; then options, or what stands alone. No words: file names.
std::string bash_words(const CommandEntry& command) {
  std::string text = "      case $before in\n";
  for (const OptionEntry& option : command.options)
    if (!option.positional && option.takes_value)
      text += "        " + joined(option.names, "|") +
              ") words=" + in_quotes(joined(option.choices, " ")) + " ;;\n";
  const OptionEntry* alone = positional_of(command);
  text += "        *) words=" +
          in_quotes(alone == nullptr ? flags_of(command) : joined(alone->choices, " ")) +
          " ;;\n      esac\n      [[ $word == -* ]] && words=" + in_quotes(flags_of(command)) +
          "\n";
  return text;
}

std::string zsh_action(const OptionEntry& option) {
  return option.choices.empty() ? "_files" : "(" + joined(option.choices, " ") + ")";
}

std::string zsh_option(const OptionEntry& option) {
  if (option.positional)
    return " \\\n        " + in_quotes("*:" + option.names.front() + ":" + zsh_action(option));
  std::string text;
  for (const std::string& name : option.names) {
    std::string spec = option.repeatable ? "*" : "(" + joined(option.names, " ") + ")";
    spec += name + "[" + escaped(option.description, "[]:\\") + "]";
    if (option.takes_value) spec += ":value:" + zsh_action(option);
    text += " \\\n        " + in_quotes(spec);
  }
  return text;
}

std::string zsh_options(const CommandEntry& command) {
  std::string text = "_arguments";
  for (const OptionEntry& option : command.options) text += zsh_option(option);
  return text + "\n";
}

std::string fish_option(const OptionEntry& option) {
  std::string text;
  for (const std::string& name : option.names) {
    if (option.positional) continue;
    text += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.choices.empty())
    text += (option.positional ? " -a " : " -x -a ") + in_quotes(joined(option.choices, " "));
  else if (option.positional)
    text += " -F";
  else if (option.takes_value)
    text += " -r -F";
  return text + " -d " + in_quotes(escaped(option.description, "\\"));
}

}  // namespace

std::string bash_completion(const CommandEntry& root) {
  std::vector<std::string> names;
  std::string cases;
  for (const CommandEntry& command : root.commands) {
    names.push_back(command.name);
    cases += "    " + command.name + ")\n" + bash_words(command) + "      ;;\n";
  }
  const std::string by_command =
      "  if ((COMP_CWORD == 1)); then\n"
      "    words=" +
      in_quotes(joined(names, " ") + " " + flags_of(root)) +
      "\n"
      "  else\n"
      "    case ${COMP_WORDS[1]} in\n" +
      cases +
      "    esac\n"
      "  fi\n";
  return "# bash completion of " + root.name + "\n_" + root.name +
         "() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=\n" +
         (root.commands.empty() ? bash_words(root) : by_command) +
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
         "}\n"
         "complete -o default -F _" +
         root.name + " " + root.name + "\n";
}

std::string zsh_completion(const CommandEntry& root) {
  const std::string begin = "#compdef " + root.name + "\n_" + root.name + "() {\n";
  const std::string end = "}\ncompdef _" + root.name + " " + root.name + "\n";
  if (root.commands.empty()) return begin + "  " + zsh_options(root) + end;
  std::string names, cases;
  for (const CommandEntry& command : root.commands) {
    names += "    " + in_quotes(escaped(command.name, ":") + ":" + command.description) + "\n";
    cases += "    " + command.name + ")\n      " + zsh_options(command) + "      ;;\n";
  }
  return begin + "  local -a commands=(\n" + names +
         "  )\n"
         "  if ((CURRENT == 2)); then\n"
         "    _describe command commands\n"
         "    return\n"
         "  fi\n"
         "  shift words\n"
         "  ((CURRENT--))\n"
         "  case $words[1] in\n" +
         cases + "  esac\n" + end;
}

std::string fish_completion(const CommandEntry& root) {
  const std::string begin = "complete -c " + root.name;
  std::string text = "# fish completion of " + root.name + "\n" + begin + " -f\n";
  const std::string at_first = root.commands.empty() ? "" : " -n __fish_use_subcommand";
  for (const OptionEntry& option : root.options)
    text += begin + at_first + fish_option(option) + "\n";
  for (const CommandEntry& command : root.commands) {
    text += begin + " -n __fish_use_subcommand -a " + command.name + " -d " +
            in_quotes(escaped(command.description, "\\")) + "\n";
    for (const OptionEntry& option : command.options)
      text += begin + " -n '__fish_seen_subcommand_from " + command.name + "'" +
              fish_option(option) + "\n";
  }
  return text;
}

std::string completion(const CommandEntry& root, const std::string& shell) {
  return shell == "bash"  ? bash_completion(root)
         : shell == "zsh" ? zsh_completion(root)
                          : fish_completion(root);
}

}  // namespace mpm::cli
