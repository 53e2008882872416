#include "config/cli/decimals.hpp"

#include <CLI/CLI.hpp>
#include <string>

namespace mpm::cli {
namespace {

std::string without_zeros(std::string& text) {
  const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t first = text.find_first_not_of('0', sign);
  // 0x10 stays what it is.
  const std::size_t kept = first == std::string::npos ? text.size() - 1 : first;
  if (kept > sign && kept < text.size() && text[kept] >= '0' && text[kept] <= '9')
    text.erase(sign, kept - sign);
  return "";
}

}  // namespace

void read_decimals(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (const std::string type = option->get_type_name();
        type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0)
      option->transform(CLI::Validator(without_zeros, ""));
  for (CLI::App* command : app.get_subcommands(nullptr)) read_decimals(*command);
}

}  // namespace mpm::cli
