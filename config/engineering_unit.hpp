#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace mpm::config {

/// An engineering unit as a product of powers of words: `kJ/(kg K)` is kJ^1 kg^-1 K^-1. A word
/// means nothing but itself: nothing is converted, kW is not kJ/s, and `%` is a word too.
class EngineeringUnit {
 public:
  /// Words with `*`, `.`, a middle dot or a blank between factors, `/`, parentheses, and powers as
  /// `m3`, `m^3` or `s^-1`; `1` and `-` have no dimension. As everywhere, what follows `/` up to
  /// the next `/` is one factor only: `kJ/kg K` is kJ kg^-1 K. Nothing for what is not written so.
  [[nodiscard]] static std::optional<EngineeringUnit> parse(std::string_view text);

  [[nodiscard]] EngineeringUnit to_the(int power) const;
  friend EngineeringUnit operator*(const EngineeringUnit& a, const EngineeringUnit& b);
  friend EngineeringUnit operator/(const EngineeringUnit& a, const EngineeringUnit& b);
  friend bool operator==(const EngineeringUnit&, const EngineeringUnit&) = default;
  /// `m3 K/h`; `1` where it has no dimension.
  friend std::string to_string(const EngineeringUnit& unit);

 private:
  std::map<std::string, int, std::less<>> powers_;  // none is 0
};

}  // namespace mpm::config
