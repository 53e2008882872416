#include "daemon/app/commands/quantity.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/app/commands/status_line.hpp"

namespace mpm::app {
namespace {

using Units = std::map<std::string, double>;

constexpr double kLongestSeconds = 1e9;  // 31 years; in ns it still fits
constexpr double kLargest = 9e15;        // exact in a double

const Units& time_units() {
  static const Units units = {{"", 1.0},     {"s", 1.0},    {"m", 60.0},
                              {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}};
  return units;
}

Units make_size_units() {
  Units units = {{"", 1.0}, {"b", 1.0}};
  double decimal = 1.0, binary = 1.0;
  for (const char* prefix : {"k", "m", "g", "t", "p"}) {
    const std::string name = prefix;
    units[name] = units[name + "b"] = decimal *= 1000.0;
    units[name + "i"] = units[name + "ib"] = binary *= 1024.0;
  }
  return units;
}

const Units& size_units() {
  static const Units units = make_size_units();
  return units;
}

/// Nothing where it is no number of that kind, or none that is finite and not negative.
std::optional<double> parse(std::string_view text, const Units& units) {
  double number = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc() || !std::isfinite(number) || number < 0.0) return std::nullopt;
  std::string_view rest = text.substr(static_cast<std::size_t>(end - text.data()));
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  const auto unit = units.find(CLI::detail::to_lower(std::string(rest)));
  if (unit == units.end()) return std::nullopt;
  return number * unit->second;
}

std::string plain(double number) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), result.ptr};
}

std::string read_time(std::string& text, bool may_be_zero) {
  const std::optional<double> seconds = parse(text, time_units());
  if (!seconds || (*seconds == 0.0 && !may_be_zero))
    return "'" + text + "' is no time" + (may_be_zero ? "" : " above 0") +
           ": seconds, or a number with s, min, h or d";
  if (*seconds > kLongestSeconds) return "'" + text + "' is too long";
  text = plain(*seconds);
  return {};
}

}  // namespace

CLI::Validator time_value() {
  return {[](std::string& text) { return read_time(text, true); }, "TIME"};
}

CLI::Validator positive_time_value() {
  return {[](std::string& text) { return read_time(text, false); }, "TIME"};
}

CLI::Validator size_value(std::uint64_t smallest) {
  return {[smallest](std::string& text) -> std::string {
            const std::optional<double> bytes = parse(text, size_units());
            if (!bytes) return "'" + text + "' is no size: bytes, or a number with kB, MB, GB ...";
            if (*bytes > kLargest) return "'" + text + "' is too large";
            if (*bytes < static_cast<double>(smallest))
              return "'" + text + "' is too small; it takes " +
                     bytes_text(static_cast<double>(smallest)) + " at least";
            text = std::to_string(static_cast<std::uint64_t>(*bytes));
            return {};
          },
          "SIZE"};
}

}  // namespace mpm::app
