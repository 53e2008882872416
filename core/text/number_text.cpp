#include "core/text/number_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace mpm {
namespace {

constexpr double kNoSurer = 0.999, kAlmost = 0.995;  // two digits of more are 1

}  // namespace

std::string number_text(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0.0 ? "infinity" : "-infinity";
  if (value == 0.0) return "0";
  char text[48];
  const double size = std::abs(value);
  if (size < 1e-4 || size >= 1e7) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
  }
  const int decimals = std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string result = text;
  if (decimals > 0) {
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') result.pop_back();
  }
  return result == "-0" ? "0" : result;
}

std::string interval_text(double low, double high, int digits) {
  constexpr int kMostDigits = 7;
  constexpr double kRounding = 1e-12;  // of the other end: what doubles leave of 0
  if (std::abs(low) < kRounding * std::abs(high)) low = 0.0;
  if (std::abs(high) < kRounding * std::abs(low)) high = 0.0;
  while (digits < kMostDigits && low != high &&
         number_text(low, digits) == number_text(high, digits))
    ++digits;
  return number_text(low, digits) + " to " + number_text(high, digits);
}

std::string percent_text(double share, int digits) {
  return number_text(100.0 * share, digits) + " %";
}

std::string sure_text(double probability) {
  if (probability > kNoSurer) return "> " + percent_text(kNoSurer, 3);
  return percent_text(probability, probability < kAlmost ? 2 : 3);
}

std::string confidence_text(double probability) {
  if (probability > kNoSurer) return "> " + number_text(kNoSurer);
  const std::string text = number_text(probability, 2);
  return text == "1" ? number_text(probability) : text;
}

std::string duration_text(double seconds) {
  constexpr std::array<std::pair<double, const char*>, 3> kUnits = {
      {{86400.0, " d"}, {3600.0, " h"}, {60.0, " min"}}};
  for (const auto& [unit, name] : kUnits)
    if (seconds >= unit && std::fmod(seconds, unit) == 0.0)
      return number_text(seconds / unit) + name;
  return number_text(seconds) + " s";
}

std::string counted(std::uint64_t count, std::string_view what) {
  std::string text = std::to_string(count) + " ";
  text.append(what);
  return count == 1 ? text : text + "s";
}

}  // namespace mpm
