#include <string>

#include "config/cli/command_tree.hpp"

namespace mpm::cli {
namespace {

/// Text as it is: no line of it a request, no mark of it an escape.
std::string roff(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    line_begins = c == '\n';
  }
  return result;
}

std::string option_text(const OptionEntry& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") +
             (option.positional ? "\\fI" + roff(name) : "\\fB" + roff(name)) + "\\fR";
  std::string choices;
  for (const std::string& choice : option.choices)
    choices += (choices.empty() ? "" : "|") + roff(choice);
  if (option.takes_value && !option.positional)
    names += " \\fI" + (choices.empty() ? "value" : choices) + "\\fR";
  return ".TP\n" + names + "\n" + roff(option.description) + "\n";
}

std::string footer_text(const CommandEntry& command) {
  return command.footer.empty() ? "" : ".PP\n.nf\n" + roff(command.footer) + "\n.fi\n";
}

}  // namespace

std::string man_page(const CommandEntry& root, const std::string& version) {
  std::string upper;
  for (const char c : root.name)
    upper += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  std::string text = ".TH " + upper + R"( 1 "" ")" + roff(version) + "\"\n.SH NAME\n" +
                     roff(root.name) + " \\- " + roff(root.description) + "\n.SH SYNOPSIS\n.B " +
                     roff(root.name) + "\n" + (root.commands.empty() ? "" : "\\fIcommand\\fR ") +
                     "[\\fIoptions\\fR]\n.SH OPTIONS\n";
  for (const OptionEntry& option : root.options) text += option_text(option);
  text += footer_text(root) + (root.commands.empty() ? "" : ".SH COMMANDS\n");
  for (const CommandEntry& command : root.commands) {
    text += ".SS " + roff(command.name) + "\n" + roff(command.description) + "\n";
    for (const OptionEntry& option : command.options) text += option_text(option);
    text += footer_text(command);
  }
  return text;
}

}  // namespace mpm::cli
