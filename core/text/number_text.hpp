#pragma once

#include <string>

/// Numbers as people read them.
namespace mpm {

/// `digits` significant ones, no exponent between 1e-4 and 1e7, no trailing zeros; "-" for NaN.
[[nodiscard]] std::string number_text(double value, int digits = 3);
/// "0.72 to 0.78"
[[nodiscard]] std::string interval_text(double low, double high, int digits = 3);
/// "25 %" of 0.25
[[nodiscard]] std::string percent_text(double share, int digits = 2);

}  // namespace mpm
