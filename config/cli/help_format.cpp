#include "config/cli/help_format.hpp"

#include <sstream>

namespace mpm::cli {
namespace {

constexpr std::size_t kColumns = 80;

}  // namespace

std::string HelpFormat::wrapped(const std::string& text) const {
  const std::size_t most = kColumns - get_column_width();
  std::istringstream words(text);
  std::string result, word;
  std::size_t length = 0;  // of the line at hand
  while (words >> word) {
    const bool fits = length + 1 + word.size() <= most;
    if (length > 0) result += fits ? ' ' : '\n';
    length = length > 0 && fits ? length + 1 + word.size() : word.size();
    result += word;
  }
  return result;
}

std::string HelpFormat::make_option_desc(const CLI::Option* option) const {
  return wrapped(CLI::Formatter::make_option_desc(option));
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  std::ostringstream out;
  CLI::detail::format_help(out, command->get_display_name(true),
                           wrapped(command->get_description()), get_column_width());
  return out.str();
}

}  // namespace mpm::cli
