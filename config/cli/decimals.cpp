#include "config/cli/decimals.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>
#include <type_traits>

namespace mpm::cli {
namespace {

template <class Whole>
std::string problem_of(const std::string& text) {
  Whole number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, number);
  if (status == std::errc::result_out_of_range && rest == end)
    return "'" + text + "' is too large a number";
  if (std::is_unsigned_v<Whole> && text.size() > 1 && text[0] == '-' &&
      text.find_first_not_of("0123456789", 1) == std::string::npos)
    return "'" + text + "' is below 0";
  return "";
}

void strip_zeros(std::string& text) {
  const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t first = text.find_first_not_of('0', sign);
  // 0x10 stays what it is.
  const std::size_t kept = first == std::string::npos ? text.size() - 1 : first;
  if (kept > sign && kept < text.size() && text[kept] >= '0' && text[kept] <= '9')
    text.erase(sign, kept - sign);
}

template <class Whole>
std::string decimal(std::string& text) {
  strip_zeros(text);
  return problem_of<Whole>(text);
}

}  // namespace

void read_decimals(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (const std::string type = option->get_type_name(); type.starts_with("INT"))
      option->transform(CLI::Validator(decimal<std::int64_t>, ""));
    else if (type.starts_with("UINT"))
      option->transform(CLI::Validator(decimal<std::uint64_t>, ""));
  for (CLI::App* command : app.get_subcommands(nullptr)) read_decimals(*command);
}

}  // namespace mpm::cli
