#include "daemon/report/page/wording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "daemon/files/times/time_text.hpp"
#include "daemon/files/times/time_unit.hpp"
#include "daemon/report/diagnosis/clock_text.hpp"

namespace mpm::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kMinute = 60.0;
constexpr int kMostDecimals = 4;  ///< of a number that is read without a power of ten
constexpr double kLargest = 1e7;
constexpr double kSmallest = 1e-3;  ///< zeros after the point are counted no further

int magnitude(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)))); }

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + ' ' + unit;
}

/// A true minus, which is as wide as a digit.
std::string typeset(const char* number) {
  std::string text = number;
  if (text[0] == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> kDigits = {"\u2070", "\u00b9", "\u00b2", "\u00b3",
                                                          "\u2074", "\u2075", "\u2076", "\u2077",
                                                          "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "\u00b710\u207b" : "\u00b710";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  return text;
}

struct Likelihood {
  double from;
  const char* word;
};
constexpr std::array<Likelihood, 5> kLikelihoods = {{{0.99, "all but certain"},
                                                     {0.9, "very likely"},
                                                     {0.7, "likely"},
                                                     {0.1, "unsure"},
                                                     {0.0, "unlikely"}}};

}  // namespace

int decimals_of(double value, double low, double high) {
  const double half = (high - low) / 2.0;
  if (std::isfinite(half) && half > 0.0) {
    // No more than five digits of the number, however narrow its interval.
    const double largest = std::max({std::abs(value), std::abs(low), std::abs(high)});
    return std::min(1 - magnitude(half), 4 - magnitude(largest));
  }
  return std::isfinite(value) && value != 0.0 ? 2 - magnitude(value) : 0;
}

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  char text[64];
  const double size = std::abs(value);
  if (size >= kLargest || (decimals > kMostDecimals && size > 0.0 && size < kSmallest)) {
    const int exponent = magnitude(value);
    std::snprintf(text, sizeof text, "%.*f", std::clamp(decimals + exponent, 0, 4),
                  value / std::pow(10.0, exponent));
    return typeset(text) + power_of_ten(exponent);
  }
  const double unit = std::pow(10.0, -decimals);
  const double said = decimals < 0 ? std::round(value / unit) * unit : value;
  std::snprintf(text, sizeof text, "%.*f", std::clamp(decimals, 0, 12), said);
  if (text[0] == '-' && std::strtod(text, nullptr) == 0.0) return typeset(text + 1);
  return typeset(text);
}

std::string rounded(double value, double low, double high, const std::string& unit) {
  return with_unit(fixed_text(value, decimals_of(value, low, high)), unit);
}

std::string rounded(double value, const std::string& unit) {
  std::string text = fixed_text(value, decimals_of(value, kUnknown, kUnknown));
  const bool plain = text.find("\u00b7") == std::string::npos;
  if (plain && text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return with_unit(text, unit);
}

std::string interval(double value, double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high)) return {};
  const int decimals = decimals_of(value, low, high);
  return fixed_text(low, decimals) + " to " + fixed_text(high, decimals);
}

std::string duration(double seconds, double low, double high) {
  const files::TimeUnit unit = files::time_unit_of(std::isfinite(seconds) ? seconds : high);
  if (!std::isfinite(low) || !std::isfinite(high))
    return rounded(seconds / unit.seconds, unit.name);
  return rounded(seconds / unit.seconds, low / unit.seconds, high / unit.seconds, unit.name);
}

std::string duration(double seconds) { return duration(seconds, kUnknown, kUnknown); }

std::string duration_interval(double seconds, double low, double high) {
  const files::TimeUnit unit = files::time_unit_of(std::isfinite(seconds) ? seconds : high);
  return interval(seconds / unit.seconds, low / unit.seconds, high / unit.seconds);
}

const char* likelihood(double probability) {
  return std::find_if(kLikelihoods.begin(), kLikelihoods.end() - 1,
                      [probability](const Likelihood& each) { return probability >= each.from; })
      ->word;
}

std::string likelihood_legend() {
  std::string text;
  for (const Likelihood& each : kLikelihoods) {
    if (!text.empty()) text += ", ";
    text += each.word;
    text += each.from > 0.0 ? ": from " + fixed_text(100.0 * each.from, 0) + " %" : ": less";
  }
  return text;
}

Clock::Clock(double start_s, double sample_time_s, std::shared_ptr<const files::TimeZone> zone)
    : dated_(is_date(start_s)), seconds_(sample_time_s < kMinute), zone_(std::move(zone)) {}

std::string Clock::zone() const {
  if (!dated_) return {};
  return zone_ == nullptr ? "UTC" : zone_->name();
}

std::string Clock::at(double seconds) const {
  if (!dated_) return duration(seconds);
  auto utc_s = static_cast<std::int64_t>(std::floor(seconds));
  if (zone_ != nullptr) utc_s += zone_->offset_s(utc_s);
  return files::formatted_utc(utc_s, seconds_ ? "%-d %b %Y %H:%M:%S" : "%-d %b %Y %H:%M");
}

std::string Clock::between(double from_s, double until_s) const {
  if (!dated_) return duration(until_s - from_s);
  return at(from_s) + " to " + at(until_s) + " (" + zone() + ")";
}

}  // namespace mpm::report
